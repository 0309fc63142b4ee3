#!/usr/bin/env python3
"""shelves.py ROOT: fails if public headers lie elsewhere than on three shelves, or a shelf holds more than 30."""
import sys
from pathlib import Path

SHELVES = {"api", "plugin", "gpu"}
MOST = 30

headers = Path(sys.argv[1]) / "core/include/hypotrack"
errors = [f"{entry}: expected a shelf of {sorted(SHELVES)}" for entry in headers.iterdir() if entry.name not in SHELVES]
for shelf in sorted(SHELVES):
    count = len(list((headers / shelf).iterdir()))
    if not 0 < count <= MOST:
        errors.append(f"{headers / shelf}: {count} headers, expected 1 to {MOST}: merge headers that are read together")
print("\n".join(errors), file=sys.stderr)
sys.exit(1 if errors else 0)
