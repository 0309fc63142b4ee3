#!/usr/bin/env bash
# each_is_dealt_once.sh BUILD: fails unless every test of the second tier is in one of the ten hands, and none is empty.
set -euo pipefail
dealt=$("$(dirname "${BASH_SOURCE[0]}")/deal.sh" "$1")
there=$(ctest --test-dir "$1" -N -L '^long$' | sed -nE 's/^Total Tests: //p')
hands=$(cut -d ' ' -f 1 <<<"$dealt" | sort -u | paste -sd ' ')
different=$(cut -d ' ' -f 2 <<<"$dealt" | sort -u | wc -l)
echo "hands $hands hold $different of $there tests"
[ "$hands" = "0 1 2 3 4 5 6 7 8 9" ] && [ "$different" = "$there" ] && [ "$(wc -l <<<"$dealt")" = "$there" ]
