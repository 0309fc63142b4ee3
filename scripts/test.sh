#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors and runs all tests. Then runs those of
# parsers, loaders and evaluators with sanitizers, in a build without the lab's packages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
install_missing_packages packages-test.txt
scripts/get_hand_detector.sh || echo "The tests of the hand detector will be skipped." >&2
for preset in dev sanitize; do
  build "$preset"
  ctest --preset "$preset" -j "$(($(nproc) + 1))" # many tests wait for most of their time
done
