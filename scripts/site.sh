#!/usr/bin/env bash
# site.sh [--no-gallery] [--build DIR] [OUT]: makes a site of the documentation in OUT (default: out/site), which any web
# server serves and which loads nothing from elsewhere. Installs what is missing (packages.txt, packages-site.txt) and
# builds, or takes the build in DIR, which needs the Python package. The gallery renders and tracks the scenes: it
# takes most of the time, and keeps its pictures in out/gallery for the next time.
set -euo pipefail
out='' build_dir='' gallery=yes
while [ $# -gt 0 ]; do
  case $1 in
    --no-gallery) gallery='' ;;
    --build) build_dir=$(realpath -e "${2:?site.sh: --build needs a folder}") && shift ;;
    -*)
      echo "site.sh: there is no option '$1'; expected site.sh [--no-gallery] [--build DIR] [OUT]" >&2
      exit 2
      ;;
    *) out=$(realpath -m "$1") ;;
  esac
  shift
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${out:-$PWD/out/site}
source scripts/setup.sh
install_missing_packages packages-site.txt
if [ -z "$build_dir" ]; then
  for build_dir in build/release build/dev ''; do [ -e "${build_dir:-.}/CMakeCache.txt" ] && break; done
  [ -n "$build_dir" ] || { configure release -DHYPOTRACK_CUDA=OFF && build_dir=build/release; }
  cmake --build "$build_dir" --target hypotrack_app hypotrack_python core/all plugins/all
fi
if ! ls "$build_dir"/python/hypotrack/_core*.so >/dev/null 2>&1; then
  echo "site.sh: $build_dir has no Python package; expected a build with pybind11-dev and python3-numpy installed" >&2
  exit 1
fi
options=()
if [ -n "$gallery" ]; then
  /usr/bin/python3 -B tools/site/gallery.py . "$build_dir/bin/hypotrack" out/gallery
  options=(--gallery out/gallery)
fi
/usr/bin/python3 -B tools/site/build_site.py . "$build_dir" "$out" "${options[@]}"
echo "The site is in $out. To look at it: python3 -m http.server --directory $out"
