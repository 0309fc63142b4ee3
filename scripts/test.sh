#!/usr/bin/env bash
# Installs what is missing, builds with warnings as errors and runs all tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
install_missing_packages packages-test.txt
build dev
ctest --preset dev -j "$(nproc)"
