#!/usr/bin/env bash
# make_readme_picture.sh [BUILD_DIR]: makes docs/pictures/two_hands.webp, the moving picture of README.md: the left view of
# configs/scenes/two_hands.yaml beside what was tracked. Needs ffmpeg.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
hypotrack=${1:-$root/build/release}/bin/hypotrack
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$hypotrack" synth "$root/configs/scenes/two_hands.yaml" --out "$scratch/recording"
"$hypotrack" run "$scratch/recording/scene.yaml" --out "$scratch/track"
part="crop=600:450:370:140,scale=400:300"
ffmpeg -v error -y -framerate 30 -i "$scratch/recording/left_%06d.png" -i "$scratch/track/overlay.mp4" \
  -filter_complex "[0]$part[a];[1]$part[b];[a][b]hstack,fps=15" \
  -c:v libwebp_anim -loop 0 -q:v 60 -compression_level 6 "$root/docs/pictures/two_hands.webp"
