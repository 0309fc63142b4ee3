#!/usr/bin/env bash
# Feeds damaged input to the readers of hypotrack, with libFuzzer and sanitizers.
#
#   scripts/fuzz.sh [TARGET...] [--runs N | --seconds N]    default: every target, 60 seconds each
#
# Inputs that reach new code stay in build/fuzz/corpus. An input that fails is kept in build/fuzz/failed.
# Once that is mended, it becomes a test as tests/fuzz/found/TARGET/NAME.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "$*; expected scripts/fuzz.sh [TARGET...] [--runs N | --seconds N]" >&2
  exit 2
}

limit=(-max_total_time=60)
targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --runs | --seconds)
      [[ ${2-} =~ ^[1-9][0-9]*$ ]] || fail "$1: '${2-}' is no number from 1 on"
      if [ "$1" = --runs ]; then limit=("-runs=$2"); else limit=("-max_total_time=$2"); fi
      shift 2
      ;;
    -*) fail "there is no option $1" ;;
    *)
      [ -d "tests/fuzz/corpus/$1" ] || fail "there is no target '$1', only: $(ls tests/fuzz/corpus | xargs)"
      targets+=("$1")
      shift
      ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls tests/fuzz/corpus)

source scripts/setup.sh
install_missing_packages packages-fuzz.txt
build fuzz

# In memory where possible: readers get files.
files=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
trap 'rm -rf "$files"' EXIT
# Mesa and others keep memory until they end.
export LSAN_OPTIONS="suppressions=$PWD/tests/sanitizers/lsan.supp:print_suppressions=0"

failed=()
mkdir -p build/fuzz/failed build/fuzz/log
for target in "${targets[@]}"; do
  new=build/fuzz/corpus/$target
  known=(tests/fuzz/corpus/"$target")
  [ -d "tests/fuzz/found/$target" ] && known+=("tests/fuzz/found/$target")
  mkdir -p "$new"
  log=build/fuzz/log/$target.txt
  if ! TMPDIR=$files "build/fuzz/tests/fuzz/fuzz_$target" "${limit[@]}" -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=1024 -max_len=8192 -print_final_stats=1 -close_fd_mask=3 \
    -artifact_prefix="build/fuzz/failed/$target-" "$new" "${known[@]}" >"$log" 2>&1; then
    failed+=("$target")
  fi
  runs=$(grep -oP 'stat::number_of_executed_units:\s*\K.*' "$log" || echo "?")
  echo "$target: $runs runs, $(grep -oP 'cov: \K\d+' "$log" | tail -1) edges covered"
  grep -hE 'Test unit written to|^SUMMARY' "$log" || true
done
[ ${#failed[@]} -eq 0 ] && exit 0
echo "Failed: ${failed[*]}. build/fuzz/log/TARGET.txt says how; repeat it with" \
  "build/fuzz/tests/fuzz/fuzz_TARGET INPUT." >&2
exit 1
