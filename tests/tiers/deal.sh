#!/usr/bin/env bash
# deal.sh BUILD [HAND]: deals the tests of the second tier into ten hands by their names. Prints hand, number and name
# of each test, or number and name of those in one hand, from 0 to 9.
set -euo pipefail
ctest --test-dir "$1" -N -L '^long$' | sed -nE 's/^ +Test +#([0-9]+): (.*)/\1 \2/p' |
  while read -r number name; do
    sum=$(cksum <<<"${name%%  # GetParam*}") # what follows may have addresses
    echo "$((${sum%% *} % 10)) $number $name"
  done | if [ $# -gt 1 ]; then sed -n "s/^$2 //p"; else cat; fi
