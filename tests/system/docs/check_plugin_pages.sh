#!/usr/bin/env bash
# check_plugin_pages.sh SOURCE_DIR BUILD_DIR: fails if docs/reference/plugins/ is stale.
set -euo pipefail
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
"$1/scripts/update_plugin_pages.sh" "$2" "$fresh/plugins"
diff -ru "$1/docs/reference/plugins" "$fresh/plugins" ||
  { echo "stale: run scripts/update_plugin_pages.sh BUILD_DIR and commit docs/reference/plugins"; exit 1; }
