#!/usr/bin/env bash
# Makes hypotrack's own hand anew, hypotrack_hand.glb, and tests it.
#
#   tools/hand_mesh/build.sh            builds and tests the generator
#   tools/hand_mesh/build.sh --write    also replaces plugins/models/hand/hypotrack_hand.glb before the tests
#
# The model `hand` is tested, too, if hypotrack is installed: CMAKE_PREFIX_PATH=PREFIX tools/hand_mesh/build.sh.
# It takes the installed file, so that a new hand needs a new installation.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$root/build/hand_mesh

if [ $# -gt 1 ] || [[ ${1---write} != --write ]]; then
  echo "build.sh: cannot read '$*'; expected tools/hand_mesh/build.sh [--write]" >&2
  exit 2
fi

cmake -S "$here" -B "$build" -G Ninja
cmake --build "$build"
[ $# -eq 0 ] || "$build/hypotrack_hand_mesh" "$root/plugins/models/hand"
ctest --test-dir "$build" --output-on-failure
