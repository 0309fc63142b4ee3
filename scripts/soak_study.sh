#!/usr/bin/env bash
# soak_study.sh [MINUTES [FOLDER]]: runs a study of short runs with `compare`, which it kills at random times and starts
# again, some with SIGTERM and some with SIGKILL. After these minutes (5) the study goes on to its end.
# Fails unless every run is there exactly once then. HYPOTRACK names another program than the build's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
minutes=${1:-5}
folder=${2:-soak_study}
program=${HYPOTRACK:-$root/build/release/bin/hypotrack}

[[ $minutes =~ ^[0-9]+$ && $minutes -gt 0 ]] ||
  { echo "soak_study.sh: '$minutes' is no number of minutes; expected 1 or more" >&2; exit 1; }
[ -x "$program" ] ||
  { echo "soak_study.sh: there is no $program; build it, or name another with HYPOTRACK" >&2; exit 1; }
mkdir -p "$folder"
rm -rf "$folder/study"
seeds=$((8 * minutes))
cat >"$folder/study.yaml" <<END
title: short runs that are killed
scenes: {hand: {file: $root/configs/scenes/demo.yaml}}
set:
  tracker: "@trackers/real_time"
  source.cameras: {width: 320, height: 180, focal_px: 175, baseline_mm: 120}
  output.worst_frames: 0
grid: {budget.evaluations: [16, 32]}
frames: 10
seeds: $seeds
END
command=("$program" compare "$folder/study.yaml" --out "$folder/study")

begin=$SECONDS
kills=0
while [ $((SECONDS - begin)) -lt $((60 * minutes)) ]; do
  "${command[@]}" >>"$folder/log.txt" 2>&1 &
  job=$!
  sleep "$((RANDOM % 8)).$((RANDOM % 10))"
  kill -0 "$job" 2>/dev/null || { wait "$job" && break; }
  signals=(KILL TERM)
  kill -"${signals[RANDOM % 2]}" "$job" 2>/dev/null || true
  kills=$((kills + 1))
  wait "$job" 2>/dev/null || true
done
"${command[@]}" >>"$folder/log.txt" 2>&1 ||
  { echo "soak_study.sh: the last compare failed; $folder/log.txt says why" >&2; exit 1; }

/usr/bin/python3 - "$folder/study" "$seeds" "$kills" <<'END'
import collections
import csv
import pathlib
import sys

study, seeds, kills = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
rows = list(csv.DictReader(open(study / "results.csv")))
times = collections.Counter((row["budget.evaluations"], row["seed"]) for row in rows)
expected = {(budget, str(seed)) for budget in ("16", "32") for seed in range(1, seeds + 1)}
wrong = [f"{run}: {times[run]} times" for run in sorted(expected | set(times)) if times[run] != 1 or run not in expected]
wrong += [f"{row['seed']}: {row['status']}, {row['frames']} frames" for row in rows if row["status"] != "ok" or row["frames"] != "10"]
folders = [path.name for path in (study / "runs").iterdir()]
if len(folders) != len(expected):
    wrong.append(f"{len(folders)} folders in runs/, expected {len(expected)}")
left = list((study / ".working").iterdir()) if (study / ".working").exists() else []
wrong += [f"{path} is left over" for path in left]
if wrong:
    sys.exit("soak_study.sh: not every run is there exactly once:\n  " + "\n  ".join(wrong[:20]))
print(f"{len(rows)} runs, each there exactly once, after {kills} kills")
END
