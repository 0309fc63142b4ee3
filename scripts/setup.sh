#!/usr/bin/env bash
# Installs the Debian packages that are missing. Sourced by demo.sh and test.sh; runs alone, too.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/install_missing_packages.sh"

# build PRESET [OPTION...]: configures, with options for cmake, and builds with one of CMakePresets.json.
# ccache is used where it is.
build() {
  local preset=$1 launcher=()
  shift
  command -v ccache >/dev/null &&
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  cmake --preset "$preset" "${launcher[@]}" "$@"
  cmake --build --preset "$preset"
}

if ! command -v apt-get >/dev/null; then
  echo "This script installs Debian packages; here there is no apt-get. Install what" \
    "scripts/packages.txt lists and build with: cmake --preset release" >&2
  exit 1
fi
install_missing_packages packages.txt
