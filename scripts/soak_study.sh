#!/usr/bin/env bash
# soak_study.sh [RUNS [FOLDER]]: makes a study of RUNS (100) short runs with `compare`, which it kills every few seconds
# and starts again, until the study is done. SIGTERM and SIGKILL take turns at random.
# Fails unless every run is there exactly once then and none was made twice. HYPOTRACK names another program than
# the build's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
runs=${1:-100}
folder=${2:-soak_study}
program=${HYPOTRACK:-$root/build/release/bin/hypotrack}

[[ $runs =~ ^[0-9]+$ && $runs -gt 1 && $((runs % 2)) = 0 ]] ||
  { echo "soak_study.sh: '$runs' is no number of runs; expected an even one from 2 on" >&2; exit 1; }
[ -x "$program" ] ||
  { echo "soak_study.sh: there is no $program; build it, or name another with HYPOTRACK" >&2; exit 1; }
mkdir -p "$folder"
rm -rf "$folder/study" "$folder/recording" "$folder/seen.txt"
seeds=$((runs / 2))
cat >"$folder/scene.yaml" <<END
models: [{name: box, type: rigid_box, size_mm: [60, 40, 20]}]
objective: {type: stereo_color}
optimizer: {type: pso}
init: {pose: {box: {position_mm: [0, 0, 500]}}}
source: {type: synthetic, cameras: {width: 64, height: 48, focal_px: 60, baseline_mm: 60}, random: {}}
END
"$program" synth "$folder/scene.yaml" --frames 2 --out "$folder/recording"
cat >"$folder/study.yaml" <<END
title: short runs that are killed
scenes: {box: {file: recording/scene.yaml}}
set: {evaluate.backend: cpu, output.overlay: false, output.worst_frames: 0}
grid: {budget.evaluations: [16, 32]}
frames: 2
seeds: $seeds
END
command=("$program" compare "$folder/study.yaml" --out "$folder/study")

kills=0
while true; do
  "${command[@]}" >>"$folder/log.txt" 2>&1 &
  job=$!
  end=$((SECONDS + 2 + RANDOM % 10))
  while [ $SECONDS -lt $end ] && kill -0 "$job" 2>/dev/null; do sleep 0.1; done
  if ! kill -0 "$job" 2>/dev/null; then
    wait "$job" && break
    echo "soak_study.sh: compare failed; $folder/log.txt says why" >&2
    exit 1
  fi
  signals=(KILL TERM)
  kill -"${signals[RANDOM % 2]}" "$job" 2>/dev/null || true
  kills=$((kills + 1))
  wait "$job" 2>/dev/null || true
  find "$folder/study/runs" -name summary.json -printf '%h %i\n' >>"$folder/seen.txt" 2>/dev/null || true
done
find "$folder/study/runs" -name summary.json -printf '%h %i\n' >>"$folder/seen.txt"

/usr/bin/python3 - "$folder" "$seeds" "$kills" <<'END'
import collections
import csv
import pathlib
import sys

folder, seeds, kills = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
study = folder / "study"
rows = list(csv.DictReader(open(study / "results.csv")))
times = collections.Counter((row["budget.evaluations"], row["seed"]) for row in rows)
expected = {(budget, str(seed)) for budget in ("16", "32") for seed in range(1, seeds + 1)}
wrong = [f"{run}: {times[run]} times" for run in sorted(expected | set(times)) if times[run] != 1 or run not in expected]
wrong += [f"{row['seed']}: {row['status']}, {row['frames']} frames" for row in rows if row["status"] != "ok" or row["frames"] != "2"]
folders = [path.name for path in (study / "runs").iterdir()]
if len(folders) != len(expected):
    wrong.append(f"{len(folders)} folders in runs/, expected {len(expected)}")
# A summary that was written again is another file: another inode.
files = collections.Counter(line.rsplit(" ", 1)[0] for line in set((folder / "seen.txt").read_text().splitlines()))
wrong += [f"{run} was made {count} times" for run, count in files.items() if count > 1]
left = list((study / ".working").iterdir()) if (study / ".working").exists() else []
wrong += [f"{path} is left over" for path in left]
if wrong:
    sys.exit("soak_study.sh: not every run is there exactly once:\n  " + "\n  ".join(wrong[:20]))
print(f"{len(rows)} runs, each there exactly once, after {kills} kills")
END
