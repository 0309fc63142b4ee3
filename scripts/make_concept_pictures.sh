#!/usr/bin/env bash
# make_concept_pictures.sh [BUILD_DIR]: draws the pictures of docs/concepts.md: one frame of configs/scenes/demo.yaml,
# searched by the paper's swarm.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${1:-$root/build/release}
cmake --build "$build" --target concept_pictures
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$build/bin/hypotrack" run "$root/configs/scenes/demo.yaml" --plugin-path "$build/tools/concept_pictures" \
  --frames 16 --seed 1 --out "$scratch/track" --set tracker=@trackers/paper --set judge=none \
  --set evaluate.backend=cpu --set evaluate.threads=1 --set tile.size=256 \
  --set "objective={type: pictures, folder: $root/docs/pictures, frame: 14}"
