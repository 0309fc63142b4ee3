#!/usr/bin/env bash
# deal.sh BUILD HAND: deals the tests of the second tier into ten hands by their names. Prints number and name of
# each test in hand HAND, from 0 to 9.
set -euo pipefail
ctest --test-dir "$1" -N -L '^long$' | sed -nE 's/^ +Test +#([0-9]+): (.*)/\1 \2/p' |
  while read -r number name; do
    sum=$(cksum <<<"$name")
    [ "$((${sum%% *} % 10))" != "$2" ] || echo "$number $name"
  done
