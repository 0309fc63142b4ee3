#!/usr/bin/env bash
# Shows that the first tier of the tests tells faults. Applies each fault of this folder to a copy of the last
# commit, builds it, runs the first tier and says which test failed.
#
#   tests/mutations/check.sh [OPTION...] [NAME...]    NAME: a fault, without .patch; default: all
#     --list       says what the faults are, and does no more
#     --full       runs all tests of a fault, and not only up to the first that fails
#     --trust      does not run the tests without a fault first
#     --build DIR  keeps the copy and its build in DIR, for the next time
#
# Fails if fewer than nine tenths are found, or if a fault does not apply or does not build.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
list='' trust='' keep='' names=() until=(--stop-on-failure)

fail() {
  echo "check.sh: $*" >&2
  exit 1
}

while [ $# -gt 0 ]; do
  case $1 in
    --list) list=yes ;;
    --full) until=() ;;
    --trust) trust=yes ;;
    --build) keep=$(realpath -m -- "${2:?a folder for --build}") && shift ;;
    -*) fail "there is no option $1, only --list, --full, --trust and --build DIR" ;;
    *) names+=("$1") ;;
  esac
  shift
done
[ ${#names[@]} -gt 0 ] || mapfile -t names < <(basename -s .patch -- "$root"/tests/mutations/*.patch)
for name in "${names[@]}"; do
  [ -f "$root/tests/mutations/$name.patch" ] || fail "there is no fault '$name'; --list says which there are"
  [ -z "$list" ] || sed -n "1s/^#/$name:/p" "$root/tests/mutations/$name.patch"
done
[ -z "$list" ] || exit 0

# A work tree of git: what is put back gets a new time, and no other file is compiled again.
folder=${keep:-$(mktemp -d)}
[ -n "$keep" ] || trap 'git -C "$root" worktree remove --force "$folder/copy"; rm -rf "$folder"' EXIT
git -C "$root" worktree prune
[ -e "$folder/copy/.git" ] || git -C "$root" worktree add --quiet --detach "$folder/copy"
cd "$folder/copy"
git checkout --quiet --force --detach "$(git -C "$root" rev-parse HEAD)"
source scripts/setup.sh
log=build/dev/mutations.log
failures=build/dev/Testing/Temporary/LastTestsFailed.log

# run_tests [ARGUMENT...]: runs the first tier, with arguments for ctest; `failed` are then the tests that failed.
# Mutations.* is left out, since no fault applies to a copy that has it.
run_tests() {
  rm -f "$failures"
  ctest --preset first -j "$(($(nproc) + 1))" -E '^Mutations[.]' "$@" >"$log" 2>&1 ||
    [ -s "$failures" ] || fail "ctest fails: $(tail -n 5 "$log")"
  mapfile -t failed < <(cut -d: -f2- "$failures" 2>/dev/null)
}

# suites_beside FAULT: a regular expression for the tests in the folders of the layers or plugins that it touches.
suites_beside() {
  sed -nE 's|^\+\+\+ b/core/src/([^/]*)/.*|tests/core/\1|p; s|^\+\+\+ b/(plugins/[^/]*)/.*|tests/\1|p' "$1" |
    { xargs -I@ find @ -name '*_test.cpp' -exec cat {} + 2>/dev/null || true; } |
    sed -nE 's/^(TYPED_)?TEST(_[FP])?\((\w+),.*/\3/p' | sort -u | paste -sd '|' | sed -E 's/.+/(^|\/)(&)[.\/]/'
}

configure dev
cmake --build --preset first
if [ -z "$trust" ]; then
  run_tests
  [ ${#failed[@]} -eq 0 ] || fail "without a fault, ${#failed[@]} tests of the first tier fail: ${failed[*]}"
fi
found=0 bad=0
for name in "${names[@]}"; do
  fault=$root/tests/mutations/$name.patch failed=()
  beside=$(suites_beside "$fault")
  if ! git apply "$fault"; then
    result="DOES NOT APPLY" bad=1
  elif ! cmake --build --preset first >"$log" 2>&1; then
    result="DOES NOT BUILD: $(tail -n 20 "$log")" bad=1
  else
    [ -z "$beside" ] || [ ${#until[@]} -eq 0 ] || run_tests "${until[@]}" -R "$beside"
    [ ${#failed[@]} -gt 0 ] || run_tests "${until[@]}"
    result="NOT FOUND"
    [ ${#failed[@]} -eq 0 ] || result="found by: ${failed[0]} (and $((${#failed[@]} - 1)) more)" found=$((found + 1))
  fi
  echo "$name: $result"
  git checkout --quiet -- .
done
echo "$found of ${#names[@]} found"
[ "$bad" -eq 0 ] && [ $((10 * found)) -ge $((9 * ${#names[@]})) ]
