#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors and runs tests.
#
#   scripts/test.sh              the first tier: the tests that tell most in least time
#   scripts/test.sh --all        all tests, then the sanitizer build of the readers, without the lab's packages
#   scripts/test.sh --deal [N]   the first tier, and hand N of the rest. Hands 0 to 9 are the second tier, dealt
#                                by the tests' names, and 10 those with sanitizers. The last commit chooses
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "test.sh: $*; expected scripts/test.sh [--all | --deal [0 to 10]]" >&2
  exit 2
}

mode=${1---first} hand=''
case $mode in
  --first | --all) [ $# -le 1 ] || fail "$mode takes nothing more" ;;
  --deal)
    commit=$(git rev-parse --short=8 HEAD) || fail "there is no commit to choose a hand; name one"
    hand=${2-$((16#${commit:0:8} % 11))}
    [[ $hand =~ ^([0-9]|10)$ ]] || fail "there is no hand '$hand'"
    ;;
  *) fail "there is no option '$mode'" ;;
esac

source scripts/setup.sh
for list in test detector package site; do install_missing_packages packages-$list.txt; done

# build_dev TARGET: builds it and gets the hand detector, without which its tests are skipped.
build_dev() {
  configure dev
  cmake --build --preset "$1"
  build/dev/bin/hypotrack get detector || echo "The tests of the hand detector will be skipped." >&2
}

# run_tests PRESET [OPTION...]: options are for ctest. Many tests wait for most of their time.
run_tests() {
  ctest --preset "$1" -j "$(($(nproc) + 1))" "${@:2}"
}

with_sanitizers() {
  build sanitize
  run_tests sanitize
}

case $mode in
  --first)
    build_dev first
    run_tests first
    ;;
  --all)
    build_dev dev
    run_tests dev
    with_sanitizers
    ;;
  --deal)
    if [ "$hand" = 10 ]; then build_dev first; else build_dev dev; fi
    run_tests first
    if [ "$hand" = 10 ]; then
      echo "Hand 10 of the rest: the tests with sanitizers"
      with_sanitizers
    else
      dealt=$(tests/tiers/deal.sh build/dev "$hand")
      echo "Hand $hand of the rest:"
      cut -d ' ' -f 2- <<<"$dealt"
      # A range of no tests, and then these.
      run_tests dev -I "0,0,0,$(cut -d ' ' -f 1 <<<"$dealt" | paste -sd ,)"
    fi
    ;;
esac
