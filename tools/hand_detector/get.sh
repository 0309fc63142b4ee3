#!/usr/bin/env bash
# get.sh [--archive FILE] [FOLDER]: `hypotrack get detector`. Puts the networks of the hand detector into
# FOLDER, by default hypotrack/hand_detector in $XDG_DATA_HOME or ~/.local/share. They are those of MediaPipe
# (Apache-2.0), from the npm package @mediapipe/hands, converted to flat files. Does nothing if they are there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
package=@mediapipe/hands
version=0.4.1675469240
archive=hands-$version.tgz
address=https://registry.npmjs.org/$package/-/$archive
python=/usr/bin/python3

fail() {
  echo "hypotrack: get detector: $*" >&2
  exit 1
}

archive_sum="bdd5be939c60cbd72a49f4b6141407683cf2a67263598e1a44757d70b3dfcb8a  $archive"
tflite_sums="\
8c026882c9ec059ce0f8e75266bee5a9a23c341a40e0000df755374d3d1b9b68  hand_landmark_full.tflite
d7fde8ac11f8ce03f8663775bfc323f4fc9f2a38062b4f4efa142874ef5b2a48  hand_landmark_lite.tflite
2f25e740121983f68ffc05f99991d524dc0ea812134f6316a26125816941ee85  palm_detection_full.tflite
e9a4aaddf90dda56a87235303cf00e4c2d3fb28725f68fd88772997dac905c18  palm_detection_lite.tflite"
network_sums="\
841a85656cecd961e4cb747394d7965b0d0cecd930e6a92d2fd6a0b38539531c  hand_landmark_full.net
68af4eef74f48dedb32b50a9e35b5ccbcdcadd0224af93f4aa80b92473526e20  hand_landmark_lite.net
23780dfe5993a9cbeb8d692688dd30f7d4f4262541c8625a7ead8db91a750181  palm_detection_full.net
3b9c901dd895898e23ddc30fcc5aeaf51b92f6505a770e6c4d939b891a108d16  palm_detection_lite.net"

# holds FOLDER SUMS: whether the files are there and have these sums.
holds() {
  (cd "$1" && sha256sum --check --status <<<"$2") 2>/dev/null
}

# Downloads the archive into the current folder.
download() {
  if command -v npm >/dev/null; then
    npm pack --silent "$package@$version" >/dev/null 2>&1 && mv ./*"$archive" "$archive" && return
  fi
  command -v curl >/dev/null || command -v npm >/dev/null ||
    fail "needs npm or curl; install the Debian package curl"
  local why='npm failed'
  command -v curl >/dev/null && why=$(curl --fail --silent --show-error --location --retry 2 \
    --connect-timeout 20 --output "$archive" "$address" 2>&1) && return
  # curl explains some errors in further lines.
  why=$(grep '^curl: ' <<<"$why" | tail --lines=1 || echo "$why")
  fail "$address cannot be downloaded ($why). Where there is no network, bring that file from" \
    "another machine, and run: hypotrack get detector --archive $archive"
}

# cut_assets BEFORE SIZE: the SIZE bytes of the package's file of assets that follow the first BEFORE ones.
cut_assets() {
  head --bytes=$(($1 + $2)) package/hands_solution_packed_assets.data 2>/dev/null | tail --bytes="$2"
}

own_archive=
if [ "${1:-}" = --archive ]; then
  [ -f "${2:-}" ] || fail "there is no file ${2:-}"
  own_archive=$(realpath "$2")
  shift 2
fi
if [ $# -eq 1 ]; then
  [ -n "$1" ] || fail "the folder's name is empty"
  folder=$1
else
  [ -n "${XDG_DATA_HOME:-${HOME:-}}" ] || fail "HOME is not set; name a folder"
  folder=${XDG_DATA_HOME:-$HOME/.local/share}/hypotrack/hand_detector
fi
if [ -f "$folder/LICENSE" ] && holds "$folder" "$network_sums"; then
  echo "The hand detector is in $folder"
  exit 0
fi

"$python" -c "import numpy" 2>/dev/null ||
  fail "needs the module numpy of $python; install the Debian package python3-numpy"

parent=$(dirname "$folder")
mkdir -p "$parent" 2>/dev/null || fail "cannot make the folder $parent"
parent=$(cd "$parent" && pwd)
folder=$parent/$(basename "$folder")
work=$(mktemp -d "$parent/.hand_detector.XXXXXX" 2>/dev/null) || fail "cannot write into $parent"
trap 'rm -rf "$work"' EXIT
cd "$work"

if [ -n "$own_archive" ]; then cp "$own_archive" "$archive"; else download; fi
holds . "$archive_sum" ||
  fail "${own_archive:-$address} is damaged: its sha256 is $(sha256sum <"$archive" | cut -c 1-64)," \
    "expected ${archive_sum%% *}"
tar --extract --gzip --no-same-owner --file "$archive" || fail "$archive cannot be unpacked"
chmod -R u+rwX package
mv package/hand_landmark_{full,lite}.tflite .
cut_assets 11 2341280 >palm_detection_full.tflite
cut_assets 2341291 1985440 >palm_detection_lite.tflite
holds . "$tflite_sums" || fail "$archive does not hold the expected networks: a sha256 differs"

mkdir ready
for network in *.tflite; do
  "$python" -B "$here/convert.py" "$network" "ready/${network%.tflite}.net" ||
    fail "$network cannot be converted"
done
holds ready "$network_sums" || fail "the converted networks differ from those that were tested"
{
  echo "The .net files here are MediaPipe's palm detectors and hand landmark networks, by Google, from the"
  echo "npm package $package $version, converted from TensorFlow Lite by hypotrack."
  echo "They are under this licence:"
  cat "$here/apache-2.0.txt"
} >ready/LICENSE
chmod 755 ready

if [ ! -e "$folder" ]; then
  mv --no-target-directory ready "$folder" || fail "cannot make the folder $folder"
else  # with damaged or missing files, and perhaps others
  mv --force ready/* "$folder/" || fail "cannot write into $folder"
fi
echo "The hand detector is in $folder"
if compgen -G "$folder/*.onnx" >/dev/null; then
  echo "The .onnx files there are those of earlier versions; nothing needs them any more."
fi
