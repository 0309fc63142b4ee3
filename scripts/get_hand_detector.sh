#!/usr/bin/env bash
# get_hand_detector.sh [FOLDER]: puts the networks of the hand detector into FOLDER, by default
# hypotrack/hand_detector in $XDG_DATA_HOME or ~/.local/share. They are those of MediaPipe (Apache-2.0), from
# the npm package @mediapipe/hands, converted to ONNX. Installs the Debian packages that this needs. Does nothing
# if they are there.
set -euo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tools=$(cd "$scripts/../tools/hand_detector" && pwd)
licence=$(cd "$scripts/.." && pwd)/LICENSE
package=@mediapipe/hands
version=0.4.1675469240
archive=hands-$version.tgz
python=/usr/bin/python3

fail() {
  echo "get_hand_detector.sh: $*" >&2
  exit 1
}

archive_sum="bdd5be939c60cbd72a49f4b6141407683cf2a67263598e1a44757d70b3dfcb8a  $archive"
tflite_sums="\
8c026882c9ec059ce0f8e75266bee5a9a23c341a40e0000df755374d3d1b9b68  hand_landmark_full.tflite
d7fde8ac11f8ce03f8663775bfc323f4fc9f2a38062b4f4efa142874ef5b2a48  hand_landmark_lite.tflite
2f25e740121983f68ffc05f99991d524dc0ea812134f6316a26125816941ee85  palm_detection_full.tflite
e9a4aaddf90dda56a87235303cf00e4c2d3fb28725f68fd88772997dac905c18  palm_detection_lite.tflite"
onnx_sums="\
b74f0ff970ed25484c0f39405aa52da40d94b236ded130d1fd84d51b20ada4fb  hand_landmark_full.onnx
76edfef15ceb4c505ce0d06fbc040ca5483a511df74e689f7238b701a08484c1  hand_landmark_lite.onnx
9e1ad1c4e06336cd262005b7a2c3fbe736842bf97faf799f365eb0089fff8a3b  palm_detection_full.onnx
9438cb4ea70848fa8e9da5fe3a0b86519175241575654fa8f8c10f5f5f11586c  palm_detection_lite.onnx"

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
  command -v curl >/dev/null &&
    curl --fail --silent --location --retry 2 --connect-timeout 20 --output "$archive" \
      "https://registry.npmjs.org/$package/-/$archive" && return
  fail "$package@$version cannot be downloaded from registry.npmjs.org; is the network there?"
}

# cut_assets BEFORE SIZE: the SIZE bytes of the package's file of assets that follow the first BEFORE ones.
cut_assets() {
  head --bytes=$(($1 + $2)) package/hands_solution_packed_assets.data 2>/dev/null | tail --bytes="$2"
}

if [ $# -gt 1 ] || [[ ${1:-} == -* ]]; then fail "usage: get_hand_detector.sh [FOLDER]"; fi
if [ $# -eq 1 ]; then
  [ -n "$1" ] || fail "the folder's name is empty"
  folder=$1
else
  [ -n "${XDG_DATA_HOME:-${HOME:-}}" ] || fail "HOME is not set; name a folder"
  folder=${XDG_DATA_HOME:-$HOME/.local/share}/hypotrack/hand_detector
fi
if [ -f "$folder/LICENSE" ] && holds "$folder" "$onnx_sums"; then
  echo "The hand detector is in $folder"
  exit 0
fi

if command -v apt-get >/dev/null; then
  source "$scripts/install_missing_packages.sh"
  install_missing_packages packages-detector.txt
fi
for module in onnx numpy; do
  "$python" -c "import $module" 2>/dev/null || fail "needs the module $module of $python; install python3-$module"
done

parent=$(dirname "$folder")
mkdir -p "$parent" 2>/dev/null || fail "cannot make the folder $parent"
parent=$(cd "$parent" && pwd)
folder=$parent/$(basename "$folder")
work=$(mktemp -d "$parent/.hand_detector.XXXXXX" 2>/dev/null) || fail "cannot write into $parent"
trap 'rm -rf "$work"' EXIT
cd "$work"

download
holds . "$archive_sum" || fail "what was downloaded as $archive is damaged: its sha256 differs"
tar --extract --gzip --no-same-owner --file "$archive" || fail "$archive cannot be unpacked"
chmod -R u+rwX package
mv package/hand_landmark_{full,lite}.tflite .
cut_assets 11 2341280 >palm_detection_full.tflite
cut_assets 2341291 1985440 >palm_detection_lite.tflite
holds . "$tflite_sums" || fail "$archive does not hold the expected networks: a sha256 differs"

mkdir ready
for network in *.tflite; do
  "$python" -B "$tools/convert.py" "$network" "ready/${network%.tflite}.onnx" ||
    fail "$network cannot be converted to ONNX"
done
holds ready "$onnx_sums" ||
  fail "the converted networks differ from those that were tested; is python3-onnx 1.12 or later?"
{
  echo "The .onnx files here are MediaPipe's palm detectors and hand landmark networks, by Google, from the"
  echo "npm package $package $version, converted from TensorFlow Lite to ONNX by hypotrack."
  echo "They are under this licence:"
  cat "$licence"
} >ready/LICENSE
chmod 755 ready

if [ ! -e "$folder" ]; then
  mv --no-target-directory ready "$folder" || fail "cannot make the folder $folder"
else  # with damaged or missing files, and perhaps others
  mv --force ready/* "$folder/" || fail "cannot write into $folder"
fi
echo "The hand detector is in $folder"
