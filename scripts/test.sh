#!/usr/bin/env bash
# Sets the machine up, builds, and runs every test through CTest.
#   --long         also the long forms of the tests
#   --asan         address and undefined-behaviour sanitizers
#   --tsan         thread sanitizer
#   --preset NAME  another build preset (default: release)
#   anything else goes to ctest, e.g. -R Phase
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=release
ctest_arguments=()
while (($#)); do
    case $1 in
        --long) export MOTE_LONG_TESTS=1 ;;
        --asan) preset=asan ;;
        --tsan) preset=tsan ;;
        --preset) preset=$2; shift ;;
        -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
        *) ctest_arguments+=("$1") ;;
    esac
    shift
done

# The libraries are not instrumented; see the suppressions for what that hides and why.
suppressions=$PWD/scripts/sanitizers
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:allocator_may_return_null=1}
export LSAN_OPTIONS=${LSAN_OPTIONS:-print_suppressions=0:suppressions=$suppressions/lsan.supp}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1:suppressions=$suppressions/ubsan.supp}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:die_after_fork=0:report_mutex_bugs=0:suppressions=$suppressions/tsan.supp}

scripts/setup.sh
scripts/build.sh "$preset"
ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" "${ctest_arguments[@]}"
