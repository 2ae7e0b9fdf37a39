#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/sanitizers/check.sh address|thread [quick|program...]
# Builds the programs of the unit, golden, conformance and stress suites and the importers, in build/asan (AddressSanitizer, its leak checker and
# UndefinedBehaviorSanitizer) or build/tsan (ThreadSanitizer, with a oneTBB of its own that has it too), and runs as many at once as there are
# processors; NAME.log there keeps what each said. Fails if one does.
# `quick` takes only the suites of the modules that handle memory, files or devices themselves; named programs (stress_test) only those.
set -eu
kind=${1:?usage: $0 address|thread [quick|program...]}
shift
cd "$(dirname "$0")/../.."
here=$PWD/tests/sanitizers
case $kind in
  address) preset=asan ;;
  thread) preset=tsan ;;
  *) echo "usage: $0 address|thread [quick|program...]" >&2; exit 2 ;;
esac
build=$PWD/build/$preset
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
if [ "$kind" = thread ]; then
  "$here/instrumented_tbb.sh" "$build/tbb"
  export LD_LIBRARY_PATH="$build/tbb/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi

cmake --preset "$preset" -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 -DVANTAGE_BUILD_CLI=ON -DVANTAGE_BUILD_EXAMPLES=OFF >/dev/null
if [ "${1-}" = quick ]; then
  set -- trace_test scan_test map_test words_test formats_test scene_test placement_test voxel_test trace_vulkan_test golden_test ranks_test image_test core_test
elif [ $# = 0 ]; then
  # Plans of whole sites and the layout of structs have nothing more to show here, and what starts the program a hundred
  # times takes an hour. The longest first.
  # shellcheck disable=SC2046 # they are words
  set -- $(cmake --build "$build" --target help | sed -n 's/^\([a-z_]*_test\): phony$/\1/p' |
           grep -vx 'sites_test\|lint_layout_test\|cli_numbers_test\|program_faults_test\|mpi_test' |
           awk '{ print /conformance|stress/ ? 0 : /scan|trace|plan/ ? 1 : 2, $0 }' | sort | cut -d ' ' -f 2)
fi
cmake --build "$build" --target "$@"

# Leaves out cases that repeat a few lines a million times for a statistic and take minutes here; others run the same lines. The conformance
# suite's own engine differs from others by a shader, which has no sanitizer, and takes a third of its time. Importers run without the limits
# and the sandbox that ChildProcessTest and one other case look at. The importer of IFC and the unpacker of LAZ are JavaScript, which has no
# sanitizer either.
# Memory and time of a program with sanitizers are none of its own.
export GTEST_FILTER="${GTEST_FILTER--RegistrationError.StandardErrorsHold:NoiseStatistics.*:*/brute_force_*:ChildProcessTest.*:ImporterTest.ReadsItsModelAndTheTablesItNamesAlone:IfcTest.*:LazSourceTest.*:Results.MemoryIsAsEstimated:Plan.IsDoneWithinTheTimeGiven}"
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$here/leaks.txt:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$here/races.txt:second_deadlock_stack=1"
under="env"
if [ "$kind" = thread ]; then
  # ThreadSanitizer ends where a library that it suppresses is unloaded, as drivers are with each instance of Vulkan. The
  # validation layer, which does not bear being kept, stays out.
  under="env LD_PRELOAD=libvulkan_lvp.so"
else
  export VANTAGE_VALIDATION=1
fi
# Those of GCC 12 know nothing of kernels that place memory at random by more than 28 bits.
if [ "$(cat /proc/sys/vm/mmap_rnd_bits 2>/dev/null || echo 0)" -gt 28 ] && setarch -R true 2>/dev/null; then
  under="setarch -R $under"
fi
export build under
# shellcheck disable=SC2016 # for the inner shell
# The conformance suite takes as long as all others together: in parts it keeps every processor at work.
for program; do
  parts=1
  if [ "$program" = conformance_test ]; then parts=8; fi
  for part in $(seq 0 $((parts - 1))); do echo "$program $part $parts"; done
done | xargs -P "$(nproc)" -L 1 sh -c '
  program=$(find "$build/tests" -type f -name "$1")
  export GTEST_SHARD_INDEX="$2" GTEST_TOTAL_SHARDS="$3"
  name=$1
  if [ "$3" -gt 1 ]; then name=$1.$(($2 + 1))of$3; fi
  log=$build/$name.log
  begin=$(date +%s)
  if $under "$program" --gtest_brief=1 >"$log" 2>&1 && ! grep -q "validation layer reports" "$log"; then
    echo "$name: passed in $(($(date +%s) - begin)) s"
  else
    cat "$log"
    echo "$name: FAILED"
    exit 1
  fi' sh
