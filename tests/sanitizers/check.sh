#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/sanitizers/check.sh address|thread [arguments of GoogleTest...]
# Builds what the unit, golden, conformance and stress suites take, in build/asan (AddressSanitizer, its leak checker and
# UndefinedBehaviorSanitizer) or build/tsan (ThreadSanitizer, with a oneTBB of its own that has it too), and runs them, each
# program as a whole. Ends with the list of those that failed.
set -eu
kind=${1:?usage: $0 address|thread [arguments of GoogleTest...]}
shift
cd "$(dirname "$0")/../.."
here=$PWD/tests/sanitizers
case $kind in
  address) preset=asan ;;
  thread) preset=tsan ;;
  *) echo "usage: $0 address|thread [arguments of GoogleTest...]" >&2; exit 2 ;;
esac
build=$PWD/build/$preset
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
if [ "$kind" = thread ]; then
  "$here/instrumented_tbb.sh" "$build/tbb"
  export LD_LIBRARY_PATH="$build/tbb/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi

cmake --preset "$preset" -DVANTAGE_BUILD_CLI=OFF -DVANTAGE_BUILD_EXAMPLES=OFF >/dev/null
# Plans of whole sites and the layout of structs have nothing more to show here.
targets=$(cmake --build "$build" --target help | sed -n 's/^\([a-z_]*_test\): phony$/\1/p' | grep -vx 'sites_test\|lint_layout_test')
# shellcheck disable=SC2086 # they are words
cmake --build "$build" --target $targets

export VANTAGE_VALIDATION=1
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$here/leaks.txt:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$here/races.txt:second_deadlock_stack=1"
failed=""
for target in $targets; do
  program=$(find "$build/tests" -type f -name "$target")
  echo "$target"
  "$program" --gtest_brief=1 "$@" || failed="$failed $target"
done
[ -z "$failed" ] || { echo "failed:$failed" >&2; exit 1; }
