#!/usr/bin/env bash
# make.sh BUILD OUT [CUDA_BUILD]: makes the packages of a build in the folder OUT. With CUDA_BUILD, a build with
# CUDA, hypotrack-cuda is in OUT/cuda. scripts/package.sh calls it.
set -euo pipefail
export SOURCE BUILD OUT CUDA_BUILD
SOURCE=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
BUILD=$(realpath "$1")
mkdir -p "$2"
OUT=$(realpath "$2")
CUDA_BUILD=${3:+$(realpath "$3")}

# The version of CMakeLists.txt, and of the commit where that is no release.
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$BUILD/CMakeCache.txt")
export MINOR=${version%.*} NEXT_MINOR
NEXT_MINOR=${MINOR%.*}.$((${MINOR#*.} + 1))
seconds=${SOURCE_DATE_EPOCH:-$(git -C "$SOURCE" log -1 --format=%ct 2>/dev/null || date +%s)}
commit=$(git -C "$SOURCE" rev-parse --short=8 HEAD 2>/dev/null || true)
if [ -n "$commit" ] && ! git -C "$SOURCE" describe --exact-match --match "v$version" >/dev/null 2>&1; then
  version+=+git$(date -u -d "@$seconds" +%Y%m%d%H%M).$commit
fi
release=$(. /etc/os-release && echo "${VERSION_ID:-0}")
eval "$(dpkg-architecture --print-set)"
export SOURCE_DATE_EPOCH=$seconds DEB_RULES_REQUIRES_ROOT=no

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$SOURCE/debian" "$work/"
cat >"$work/debian/changelog" <<END
hypotrack ($version-1~deb$release) unstable; urgency=medium

  * Packages of this version. The upstream changelog tells what is new.

 -- $(sed -n 's/^Maintainer: //p' "$work/debian/control")  $(date -uR -d "@$seconds")
END
# What report pages contain of others.
{
  printf '\nFiles: lab/report/*\nCopyright: see below\nLicense: as-in-report\n\nLicense: as-in-report\n'
  sed 's/^$/./; s/^/ /' "$SOURCE/lab/report/web/licences.txt"
} >>"$work/debian/copyright"
rm -rf "$OUT"/*hypotrack*.deb "$OUT/cuda"
cd "$work"
debian/rules binary
if [ -n "$CUDA_BUILD" ]; then  # apart, because it conflicts with libhypotrack0
  mkdir "$OUT/cuda"
  mv "$OUT"/hypotrack-cuda_*.deb "$OUT/cuda/"
fi
