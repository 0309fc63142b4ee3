#!/usr/bin/env bash
# From nothing to a tracked hand: installs what is missing, builds, renders the demo recording, tracks
# it and says where everything is. Takes the folder for the results (default: out/demo).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
out=${1:-out/demo}
# For this machine's GPU alone, if it has one: code for all of them takes many times as long to compile.
gpu=(-DHYPOTRACK_CUDA=OFF)
if nvidia-smi -L 2>/dev/null | grep -q '^GPU'; then
  gpu=(-DHYPOTRACK_CUDA=AUTO -DCMAKE_CUDA_ARCHITECTURES=native)
fi
build release "${gpu[@]}"
hypotrack=build/release/bin/hypotrack

rm -rf "$out/recording"
"$hypotrack" synth configs/scenes/demo.yaml --out "$out/recording"
"$hypotrack" run "$out/recording/scene.yaml" --out "$out/track"
"$hypotrack" report "$out/track"

echo
echo "The recording:      $out/recording (left_*.png, right_*.png, calibration.yaml, truth)"
echo "The overlay video:  $out/track/overlay.mp4"
echo "The tables:         $out/track/track.csv, joints.csv, errors.csv"
echo "The report:         $out/track/report.html (open it in a browser)"
echo "The numbers:        $out/track/summary.json"
cat "$out/track/summary.json"
