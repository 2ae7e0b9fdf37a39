#!/usr/bin/env bash
# Fuzzes every target, or those named: tests/fuzz/run.sh SECONDS [TARGET...]
#
# Each runs for so many seconds from its seeds and earlier findings, and for half as many from nothing. The corpus is in build/fuzz/corpus, inputs
# that break a promise in build/fuzz/findings; then the exit code is 1. VANTAGE_FUZZ_JOBS targets at a time, all cores otherwise.
# Needs the build of `cmake --preset fuzz && cmake --build --preset fuzz`; VANTAGE_FUZZ_PROGRAM names another.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:?usage: $0 SECONDS [TARGET...]}
shift
here=tests/fuzz
program=${VANTAGE_FUZZ_PROGRAM:-build/fuzz/tests/fuzz/vantage-fuzz}
output=${VANTAGE_FUZZ_OUTPUT:-build/fuzz}
jobs=${VANTAGE_FUZZ_JOBS:-$(nproc)}
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=($(ls $here/seeds))

dictionary_of() {
  case $1 in
    gltf) echo gltf ;;
    image | panorama) echo image ;;
    configuration | command_line) echo options ;;
    front_json) echo front ;;
    stations_csv) echo stations ;;
    scanners_json) echo scanners ;;
    region_geojson) echo geojson ;;
    crs) echo crs ;;
    *) echo numbers ;;
  esac
}

# fuzz TARGET: 0 where nothing was found.
fuzz() {
  local target=$1 corpus=$output/corpus/$1 fresh findings=$output/findings/$1
  fresh=$(mktemp -d)
  mkdir -p "$corpus" "$findings"
  local options=(--target="$target" -dict="$here/dictionaries/$(dictionary_of "$target").dict" -artifact_prefix="$findings/"
    -timeout=20 -rss_limit_mb=4096 -max_len=65536 -print_final_stats=1)
  "$program" "${options[@]}" -max_total_time="$seconds" "$corpus" "$here/seeds/$target" >"$findings/log" 2>&1
  local failed=$?
  "$program" "${options[@]}" -max_total_time=$(((seconds + 1) / 2)) "$fresh" >"$findings/log.fresh" 2>&1 || failed=1
  rm -rf "$fresh"
  printf '%-16s %12s executions  %12s fresh  coverage %6s  %s\n' "$target" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$findings/log")" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$findings/log.fresh")" \
    "$(grep -o 'cov: [0-9]*' "$findings/log" | tail -n 1 | cut -d' ' -f2)" \
    "$([ $failed = 0 ] && echo "no finding" || echo "FINDING, see $findings")"
  return $failed
}

failed=0
running=0
for target in "${targets[@]}"; do
  [ -d "$here/seeds/$target" ] || { echo "there is no target $target" >&2; exit 2; }
  fuzz "$target" &
  running=$((running + 1))
  if [ $running -ge "$jobs" ]; then
    wait -n || failed=1
    running=$((running - 1))
  fi
done
while [ $running -gt 0 ]; do
  wait -n || failed=1
  running=$((running - 1))
done
exit $failed
