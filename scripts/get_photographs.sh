#!/usr/bin/env bash
# get_photographs.sh: puts the photographs that studies show behind hands into configs/photographs/.
# They are those of Debian's package opencv-doc; nothing is installed.
set -euo pipefail
target=$(cd "$(dirname "$0")/.." && pwd)/configs/photographs
photographs=(aloeL.jpg fruits.jpg graf1.png home.jpg leuvenA.jpg stuff.jpg)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
chmod 755 "$folder"  # apt downloads as another user
cd "$folder"
apt-get download opencv-doc >/dev/null ||
  { echo "opencv-doc cannot be downloaded; it needs Debian or Ubuntu, after 'apt-get update'" >&2; exit 1; }
dpkg -x opencv-doc_*.deb package

mkdir -p "$target"
for name in "${photographs[@]}"; do
  found=$(find package -name "$name" -o -name "$name.gz" | head -n 1)
  [ -n "$found" ] || { echo "opencv-doc has no $name" >&2; exit 1; }
  case $found in
    *.gz) gunzip -c "$found" >"$target/$name" ;;
    *) cp "$found" "$target/$name" ;;
  esac
done
echo "${#photographs[@]} photographs are in $target"
