#!/usr/bin/env bash
# The whole suite under the address, undefined-behaviour and thread sanitizers, with the time that each took.
#   cmake/sanitize.sh [asan-ubsan] [tsan] [-- arguments of ctest]
set -euo pipefail
cd "$(dirname "$0")/.."
presets=()
while [ $# -gt 0 ] && [ "$1" != "--" ]; do presets+=("$1"); shift; done
[ $# -gt 0 ] && shift
[ ${#presets[@]} -gt 0 ] || presets=(asan-ubsan tsan)
status=0
for preset in "${presets[@]}"; do
  begun=$SECONDS
  cmake --preset "$preset" > /dev/null
  cmake --build "build/$preset" -j "$(nproc)"
  built=$SECONDS
  verdict=clean
  ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" --timeout 3600 "$@" || { verdict=FINDINGS; status=1; }
  echo "$preset: built in $((built - begun)) s, tests in $((SECONDS - built)) s, $verdict"
done
exit $status
