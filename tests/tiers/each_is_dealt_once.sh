#!/usr/bin/env bash
# each_is_dealt_once.sh BUILD: fails unless every test of the second tier is in one of the ten hands, and none is empty.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
dealt=$(mktemp)
trap 'rm -f "$dealt"' EXIT
for hand in {0..9}; do
  "$here/deal.sh" "$1" "$hand" >"$dealt.$hand"
  [ -s "$dealt.$hand" ] || { echo "hand $hand is empty"; exit 1; }
  cat "$dealt.$hand" >>"$dealt" && rm "$dealt.$hand"
done
there=$(ctest --test-dir "$1" -N -L '^long$' | sed -nE 's/^Total Tests: //p')
echo "$(wc -l <"$dealt") dealt, $(sort -u "$dealt" | wc -l) different, $there in the second tier"
[ "$(wc -l <"$dealt")" = "$there" ] && [ "$(sort -u "$dealt" | wc -l)" = "$there" ]
