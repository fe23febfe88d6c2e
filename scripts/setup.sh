#!/usr/bin/env bash
# Installs the Debian packages that mote needs and this machine lacks. Does nothing, quickly, when
# all are there. Without the right to install it says what is missing and exits with 1.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

missing=()
while read -r package; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [[ $status == "install ok installed" ]] || missing+=("$package")
done < <(grep -v '^#' "$here/packages.txt")

if ((${#missing[@]} == 0)); then
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
        as_root=(sudo)
    elif command -v sudo >/dev/null && [[ -t 0 ]]; then
        echo "mote needs these Debian packages: ${missing[*]}"
        as_root=(sudo)
    else
        echo "mote needs these Debian packages, and may not install them. As root, run:" >&2
        echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
fi

echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
