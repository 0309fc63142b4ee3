#!/usr/bin/env bash
# Installs the Debian packages that are missing. Sourced by demo.sh and test.sh; runs alone, too.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/install_missing_packages.sh"

# configure PRESET [OPTION...]: configures with one of CMakePresets.json, and options for cmake. ccache is used
# where it is.
configure() {
  local launcher=()
  command -v ccache >/dev/null &&
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  cmake --preset "$1" "${launcher[@]}" "${@:2}"
}

# build PRESET [OPTION...]: the same, and builds.
build() {
  configure "$@"
  cmake --build --preset "$1"
}

if ! command -v apt-get >/dev/null; then
  echo "This script installs Debian packages; here there is no apt-get. Install what" \
    "scripts/packages.txt lists and build with: cmake --preset release" >&2
  exit 1
fi
install_missing_packages packages.txt
