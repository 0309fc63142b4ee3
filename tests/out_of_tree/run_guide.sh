#!/usr/bin/env bash
# run_guide.sh BUILD_DIR GUIDE.md: installs BUILD_DIR into a temporary folder, writes the guide's code
# blocks (```lang file=NAME) into another one and executes its steps (```sh step=NAME) there.
set -euo pipefail
build_dir=$1
guide=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PREFIX=$scratch/prefix
unset HYPOTRACK_PLUGIN_PATH HYPOTRACK_DATA_PATH

cmake --install "$build_dir" --prefix "$PREFIX" >"$scratch/install.log"
mkdir "$scratch/plugins"
cd "$scratch/plugins"
awk '
  /^```/ && out { close(out); out = ""; next }
  /^```/ && match($0, /(file|step)=[A-Za-z0-9_.]+/) {
    name = substr($0, RSTART + 5, RLENGTH - 5)
    out = (substr($0, RSTART, 4) == "step") ? "step_" name ".sh" : name
    next
  }
  out { print > out }' "$guide"

for file in silhouette.cpp hill_climb.cpp can.cpp CMakeLists.txt scene.yaml step_build.sh step_run.sh; do
  [ -s "$file" ] || { echo "the guide has no block for $file"; exit 1; }
done
bash -e step_build.sh
bash -e step_run.sh

for file in track.csv joints.csv errors.csv run.yaml summary.json overlay.mp4; do
  [ -s "result/$file" ] || { echo "the run left no $file"; exit 1; }
done
grep -q '"lost_frames": 0' result/summary.json || { echo "the can was lost"; exit 1; }
grep -q '"frames": 10' result/summary.json || { echo "not all frames were tracked"; exit 1; }
