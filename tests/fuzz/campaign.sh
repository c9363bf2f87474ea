#!/usr/bin/env bash
# Every fuzz target for a time, on as many cores as there are; then what of the code it has reached.
#   tests/fuzz/campaign.sh SECONDS [TARGET ...]
# Findings stay below build/fuzz/findings, corpora below build/fuzz/corpora. Ends with 1 where there is a finding.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -ge 1 ] || { echo "usage: tests/fuzz/campaign.sh SECONDS [TARGET ...]" >&2; exit 2; }
seconds=$1; shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  mapfile -t targets < <(sed -n 's/^madori_fuzzer(\([a-z0-9_]*\).*/\1/p' tests/fuzz/CMakeLists.txt)
fi
cmake --preset fuzz > /dev/null
cmake --build build/fuzz --target fuzz_seeds "${targets[@]/#/fuzz_}"
build/fuzz/tests/fuzz/fuzz_seeds build/fuzz/seeds
mkdir -p build/fuzz/findings
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm  # what targets write to files need not go to a disk
one() {
  name=$1
  mkdir -p "build/fuzz/corpora/$name"
  seeds=()
  for folder in "build/fuzz/seeds/$name" "tests/fuzz/corpus/$name"; do [ ! -d "$folder" ] || seeds+=("$folder"); done
  log="build/fuzz/findings/$name.log"
  if "build/fuzz/tests/fuzz/fuzz_$name" -max_total_time="$2" -max_len=65536 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
      -artifact_prefix="build/fuzz/findings/$name-" "build/fuzz/corpora/$name" "${seeds[@]}" > "$log" 2>&1; then verdict=clean; else verdict=FINDING; fi
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  reached=$(grep -o 'cov: [0-9]* ft: [0-9]*' "$log" | tail -1)
  printf '%-12s %-8s %12s runs  %s\n' "$name" "$verdict" "${runs:-?}" "$reached"
}
export -f one
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'one {} '"$seconds" | tee build/fuzz/findings/summary.txt
! grep -q FINDING build/fuzz/findings/summary.txt
