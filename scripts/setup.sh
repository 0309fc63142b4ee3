#!/usr/bin/env bash
# Installs the Debian packages that are missing. Sourced by demo.sh and test.sh; runs alone, too.
set -euo pipefail

# install_missing_packages LIST: a file of this folder with a package a line.
install_missing_packages() {
  local here missing=() package sudo=()
  here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
  while read -r package; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing+=("$package")
  done < <(grep -v '^#' "$here/$1")
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "These Debian packages are missing and need root to install: ${missing[*]}" >&2
      return 1
    fi
    sudo=(sudo)
  fi
  echo "Installing: ${missing[*]}"
  "${sudo[@]}" apt-get update -qq
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

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
