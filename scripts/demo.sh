#!/usr/bin/env bash
# From nothing to a tracked hand: installs what is missing, builds, renders the demo recording, tracks
# it and says where everything is. Takes the folder for the results (default: out/demo).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
out=${1:-out/demo}
build release
hypotrack=build/release/bin/hypotrack

rm -rf "$out/recording"
"$hypotrack" synth configs/demo.yaml --out "$out/recording"
"$hypotrack" run "$out/recording/scene.yaml" --out "$out/track"

echo
echo "The recording:      $out/recording (left_*.png, right_*.png, calibration.yaml, truth)"
echo "The overlay video:  $out/track/overlay.mp4"
echo "The tables:         $out/track/track.csv, joints.csv, errors.csv"
echo "The numbers:        $out/track/summary.json"
cat "$out/track/summary.json"
