#!/usr/bin/env bash
# run_new_plugins.sh BUILD_DIR: installs BUILD_DIR into a temporary folder and writes a plugin of every
# kind with it. All must build, pass their contract tests and run.
set -euo pipefail
build_dir=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
unset HYPOTRACK_PLUGIN_PATH HYPOTRACK_DATA_PATH
export CXXFLAGS="-Wall -Wextra -Werror"  # as authors may compile

fail() { echo "$1"; exit 1; }

cmake --install "$build_dir" --prefix "$scratch/prefix" >"$scratch/install.log"
hypotrack=$scratch/prefix/bin/hypotrack
cd "$scratch"
kinds=$(sed -n 's/^  KIND(\([a-z]*\), .*/\1/p' prefix/include/hypotrack/plugin/plugin.hpp)
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(all LANGUAGES CXX)' 'enable_testing()' \
  >CMakeLists.txt
for kind in $kinds; do
  "$hypotrack" plugins new "$kind" "my_$kind" >steps.txt
  grep -q "my_$kind/scene.yaml" steps.txt || fail "$kind: the next steps are not said"
  echo "add_subdirectory(my_$kind)" >>CMakeLists.txt
done
"$hypotrack" plugins new objective on_both --cuda >/dev/null
echo "add_subdirectory(on_both)" >>CMakeLists.txt

# The guide's own test compiles the same GPU part.
cmake -S . -B build -DCMAKE_PREFIX_PATH="$scratch/prefix" -DCMAKE_BUILD_TYPE=Release -DHYPOTRACK_CUDA=OFF
cmake --build build
ctest --test-dir build --output-on-failure
for kind in $kinds; do
  "$hypotrack" --plugin-path "build/my_$kind" run "my_$kind/scene.yaml" --out "result_$kind" \
    --set output.overlay=false
  grep -q '"lost_frames": 0' "result_$kind/summary.json" || fail "$kind: the object was lost"
  grep -q '"frames": 10' "result_$kind/summary.json" || fail "$kind: not all frames were tracked"
done

# What is there is not overwritten, and nothing is left of what cannot be.
"$hypotrack" plugins new output my_output 2>message.txt && fail "a folder was overwritten"
grep -q 'my_output: exists already; give another folder' message.txt || fail "$(cat message.txt)"
"$hypotrack" plugins new model class 2>message.txt && fail "a name was taken that C++ does not allow"
grep -q "which C++ code cannot use as its own" message.txt || fail "$(cat message.txt)"
"$hypotrack" plugins new starter mine --cuda 2>message.txt && fail "a starter has no part for GPUs"
grep -q "only an objective has a part for GPUs" message.txt || fail "$(cat message.txt)"
[ -z "$(find . -maxdepth 1 \( -name class -o -name mine -o -name '*.part' \))" ] || fail "something was left"
