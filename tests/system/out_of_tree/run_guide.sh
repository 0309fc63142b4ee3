#!/usr/bin/env bash
# run_guide.sh BUILD_DIR GUIDE.md: installs BUILD_DIR into a temporary folder, writes the guide's code
# blocks (```lang file=NAME) into another one and executes its steps (```sh step=NAME) there. The
# plugins with a device part are built with CUDA where there is a toolkit, and without in any case.
set -euo pipefail
build_dir=$1
guide=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export PREFIX=$scratch/prefix
unset HYPOTRACK_PLUGIN_PATH HYPOTRACK_DATA_PATH
export CXXFLAGS="-Wall -Wextra -Werror"  # as authors may compile

fail() { echo "$1"; exit 1; }

extract_blocks() {
  awk '
    /^```/ && out { close(out); out = ""; next }
    /^```/ && match($0, /(file|step)=[A-Za-z0-9_.-]+/) {
      name = substr($0, RSTART + 5, RLENGTH - 5)
      out = (substr($0, RSTART, 4) == "step") ? "step_" name ".sh" : name
      next
    }
    out { print > out }' "$guide"
  local file
  for file in silhouette.cpp hill_climb.cpp can.cpp in_front.cpp same_colors.cpp trajectory.cpp CMakeLists.txt scene.yaml step_build.sh \
    step_run.sh fast_silhouette{-inl.hpp,.hpp,.cpp,.cu} no_cuda.cpp upright{.hpp,.cpp,.cu} \
    upright_no_cuda.cpp euroc.cpp standing_can.yaml step_run_standing.sh; do
    [ -s "$file" ] || fail "the guide has no block for $file"
  done
}

# check_run FOLDER BACKEND: a run of ten frames that kept the can.
check_run() {
  local file
  for file in track.csv joints.csv errors.csv run.yaml summary.json overlay.mp4; do
    [ -s "$1/$file" ] || fail "the run left no $1/$file"
  done
  grep -q '"lost_frames": 0' "$1/summary.json" || fail "$1: the can was lost"
  grep -q '"frames": 10' "$1/summary.json" || fail "$1: not all frames were tracked"
  grep -q "\"backend\": \"$2 " "$1/summary.json" ||
    fail "$1: expected backend $2, found $(grep backend "$1/summary.json")"
}

cmake --install "$build_dir" --prefix "$PREFIX" >"$scratch/install.log"
mkdir "$scratch/plugins"
cd "$scratch/plugins"
extract_blocks
cmp euroc.cpp "$(dirname "$guide")/examples/plugin_source/euroc.cpp"
bash -e step_build.sh
bash -e step_run.sh
check_run result cpu
head -n 1 result/track.csv | grep -q ',distance_m$' || fail "track.csv lacks the column distance_m"
[ "$(wc -l <result/trajectory.txt)" = 10 ] || fail "the trajectory has not a line for every frame"

built_with_cuda() { compgen -G 'build/CMakeFiles/*/CMakeCUDACompiler.cmake' >/dev/null; }
backend=cpu
if built_with_cuda && nvidia-smi -L >/dev/null 2>&1; then backend=cuda; fi
bash -e step_run_standing.sh
check_run standing "$backend"

if built_with_cuda; then
  rm -rf build standing
  sed 's/cmake -B build/& -DHYPOTRACK_CUDA=OFF/' step_build.sh | bash -e
  built_with_cuda && fail "HYPOTRACK_CUDA=OFF enabled CUDA all the same"
  bash -e step_run_standing.sh
  check_run standing cpu
fi
