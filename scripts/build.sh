#!/usr/bin/env bash
# build.sh PRESET [TARGET...]: configures and builds one preset; output only if something fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=$1
shift

log=build/$preset.log
mkdir -p build
echo "building mote ($preset); the first time takes some minutes"
if ! { cmake --preset "$preset" && cmake --build --preset "$preset" ${1:+--target "$@"}; } >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    echo "the build failed; the whole log is in $log" >&2
    exit 1
fi
