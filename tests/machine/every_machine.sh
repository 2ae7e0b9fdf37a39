#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/machine/every_machine.sh [build folder] [arguments of ctest...]
# The whole suite, once for each instruction set of Embree that this processor can run, and once for each width of lavapipe's vectors. An
# hour or so on two cores. Ends with the first run that fails.
set -eu
build=${1:-build/release}
[ $# -gt 0 ] && shift
for pair in sse4.2=sse4_2 avx=avx avx2=avx2 avx512=avx512vl; do
  isa=${pair%=*}
  if ! grep -qw "${pair#*=}" /proc/cpuinfo; then
    echo "not run: $isa, which this processor lacks"
    continue
  fi
  echo "VANTAGE_EMBREE_ISA=$isa"
  VANTAGE_EMBREE_ISA=$isa ctest --test-dir "$build" --output-on-failure "$@"
done
for width in 128 256 512; do
  echo "LP_NATIVE_VECTOR_WIDTH=$width"
  LP_NATIVE_VECTOR_WIDTH=$width ctest --test-dir "$build" --output-on-failure "$@"
done
