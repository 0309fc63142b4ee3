#!/usr/bin/env bash
# each_applies.sh SOURCE_DIR: fails unless each fault of tests/mutations applies to the sources. Needs no git.
set -euo pipefail
cd "$1"
status=0
for fault in tests/mutations/*.patch; do
  patch --dry-run --force --silent --fuzz=0 -p1 <"$fault" && continue
  echo "$fault does not apply; make the same fault in the sources as they are, and renew it (CONTRIBUTING.md)"
  status=1
done
exit "$status"
