#!/usr/bin/env bash
# merge_folders.sh STUDY [options of compare]: two machines without a shared folder make a share each. The runs of both in the
# first one's folder must give the tables of one machine, without a new run. HYPOTRACK names the program.
set -euo pipefail
study=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$HYPOTRACK" compare "$study" --out whole "$@"
for i in 1 2; do "$HYPOTRACK" compare "$study" --out machine_$i --shard $i/2 "$@"; done
cp -r machine_1 merged
cp -r machine_2/runs merged/
"$HYPOTRACK" compare "$study" --out merged "$@" 2>&1 | tee log
grep -q ", 0 to make here" log || { echo "expected no run to be made again"; exit 1; }
for table in results.csv cells.csv; do cmp whole/$table merged/$table; done
"$HYPOTRACK" report merged --no-images
test -s merged/report.html
