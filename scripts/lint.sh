#!/usr/bin/env bash
# Checks layout (clang-format) and common mistakes (clang-tidy) of the given files, or of all.
# By hand only: neither tool is among scripts/packages.txt (Debian: clang-format clang-tidy).
#   scripts/lint.sh [--format] [FILE...]
#   --format   layout only: the other checks take seconds per file, half a minute with OpenVDB
# Needs a configured build/release, where compile_commands.json lies.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=yes
files=()
for argument in "$@"; do
    case $argument in
        --format) tidy=no ;;
        -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
        *) files+=("$argument") ;;
    esac
done
((${#files[@]})) || mapfile -t files < <(git ls-files '*.h' '*.cpp')

clang-format --dry-run -Werror "${files[@]}"
[[ $tidy == yes ]] || exit 0
# Headers are checked where they are included.
printf '%s\n' "${files[@]}" | { grep '\.cpp$' || true; } |
    xargs -r -n 1 -P "$(nproc)" clang-tidy -p build/release --quiet
