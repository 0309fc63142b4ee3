#!/usr/bin/env bash
# update_plugin_pages.sh [BUILD_DIR [OUT]]: writes docs/reference/plugins/ from the plugins' parameters.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=${1:-$root/build/release}
out=${2:-$root/docs/reference/plugins}
hypotrack=$build_dir/bin/hypotrack
unset HYPOTRACK_PLUGIN_PATH HYPOTRACK_DATA_PATH
kinds=$(sed -n 's/^  KIND(\([a-z]*\), .*/\1/p' "$root/core/include/hypotrack/plugin/plugin.hpp")
list=$("$hypotrack" plugins list) # before anything is removed
rm -rf "$out"
mkdir -p "$out"
{
  echo "# Plugins"
  echo
  echo "Made by \`scripts/update_plugin_pages.sh\` from the plugins' parameters."
  for kind in $kinds; do
    echo
    echo "**${kind^}s**"
    echo
    awk -v kind=$kind '$1 == kind { print $2 }' <<<"$list" | while read -r name; do
      "$hypotrack" plugins info "$kind/$name" --markdown >"$out/${kind}_$name.md"
      echo "- [$name](${kind}_$name.md): $(sed -n 3p "$out/${kind}_$name.md")"
    done
  done
  echo
  echo "## Capabilities"
  echo
  echo "What a plugin offers or needs beyond its kind."
  echo
  "$hypotrack" plugins capabilities --markdown
  echo
  echo "## Measures"
  echo
  echo "What [judges](../judges.md) know about the pose of a model in a frame."
  echo
  "$hypotrack" plugins measures --markdown
} >"$out/index.md"
