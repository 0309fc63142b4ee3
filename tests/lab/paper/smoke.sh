#!/usr/bin/env bash
# smoke.sh HYPOTRACK STUDY: the study's smoke variant succeeds and every row of its tables has an error.
set -euo pipefail
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$1" compare "$2" --variant smoke --out "$out/study" --jobs 2
awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mean_error_mm") column = i
            if (!column) { print "no column mean_error_mm"; exit 1 } }
  NR > 1 && $column == "" { print "no error in: " $0; exit 1 }
  END { if (NR < 2) { print "no rows"; exit 1 } }' "$out/study/results.csv"
