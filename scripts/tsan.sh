#!/usr/bin/env bash
# Runs the tests with ThreadSanitizer, and with a oneTBB that is built with it: without, TSan does not
# see which tasks wait for one another.
#
#   scripts/tsan.sh [OPTION...]    options are for ctest: -R NAMES, -j N
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
install_missing_packages packages-test.txt
install_missing_packages packages-tsan.txt

# build_tbb FOLDER: builds Debian's source of the installed oneTBB with ThreadSanitizer.
build_tbb() {
  local work
  work=$(mktemp -d)
  mkdir -p "$work/lists/partial" "$work/sources"
  # The system's own sources of packages may leave out source code.
  for list in /etc/apt/sources.list.d/*.sources; do
    sed 's/^Types:.*/Types: deb-src/' "$list" >"$work/sources/$(basename "$list")"
  done
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -f "$list" ] || sed 's/^deb /deb-src /' "$list" >"$work/sources/$(basename "$list")"
  done
  local apt=(apt-get -qq -o Dir::Etc::sourcelist=- -o "Dir::Etc::sourceparts=$work/sources"
    -o "Dir::State::lists=$work/lists" -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache=
    -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$work" && "${apt[@]}" source --download-only "onetbb=$(dpkg-query -W -f '${Version}' libtbb12)")
  dpkg-source --no-check -x "$work"/onetbb*.dsc "$work/onetbb"
  cmake -S "$work/onetbb" -B "$work/build" -G Ninja -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DTBB_SANITIZE=thread -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_INSTALL_PREFIX=$1.part"
  cmake --build "$work/build" --target install
  mv "$1.part" "$1"
  rm -r "$work"
}

tbb=$PWD/build/tsan-tbb
[ -d "$tbb" ] || build_tbb "$tbb"
build tsan "-DTBB_DIR=$tbb/lib/cmake/TBB"
# TSan needs addresses that many kernels of today do not give.
LD_LIBRARY_PATH=$tbb/lib setarch -R ctest --preset tsan "$@"
