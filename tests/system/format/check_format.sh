#!/usr/bin/env bash
# check_format.sh SOURCE_DIR CLANG_FORMAT: fails if the program would change a source.
set -euo pipefail
cd "$1"
find core lab plugins tests tools examples -path tools/hand_mesh -prune -o -type f \
  \( -name '*.cpp' -o -name '*.hpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 |
  xargs -0 -P2 -n 40 "$2" --dry-run -Werror
