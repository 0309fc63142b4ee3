#!/usr/bin/env bash
# soak.sh [MINUTES [FOLDER]]: tracks a rendered hand with the recommended tracker in one process, for 10 minutes
# unless told otherwise. FOLDER (soak) gets soak.csv, a sample every few seconds, and soak.svg, the same drawn.
# Fails if memory, descriptors, threads or the time of a frame drift. HYPOTRACK names another program than the build's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
minutes=${1:-10}
folder=${2:-soak}
program=${HYPOTRACK:-$root/build/release/bin/hypotrack}
period=5  # seconds between samples

[[ $minutes =~ ^[0-9]+$ && $minutes -gt 0 ]] ||
  { echo "soak.sh: '$minutes' is no number of minutes; expected 1 or more" >&2; exit 1; }
[ -x "$program" ] ||
  { echo "soak.sh: there is no $program; build it, or name another with HYPOTRACK" >&2; exit 1; }
mkdir -p "$folder"
rm -rf "$folder/run"
/usr/bin/python3 "$root/scripts/soak_scene.py" "$minutes" "$root/configs/scenes/demo.yaml" >"$folder/scene.yaml"

"$program" run "$folder/scene.yaml" --out "$folder/run" >"$folder/log.txt" 2>&1 &
run=$!
trap 'kill -TERM $run 2>/dev/null || true' EXIT

gpu_memory() {  # MiB of the run; empty without an NVIDIA GPU
  command -v nvidia-smi >/dev/null || return 0
  nvidia-smi --query-compute-apps=pid,used_memory --format=csv,noheader,nounits 2>/dev/null |
    awk -F', ' -v pid="$run" '$1 == pid {print $2; exit}'
}
value() { awk -v key="$1:" '$1 == key {print $2}' "/proc/$run/status"; }

echo seconds,frames,rss_mib,descriptors,threads,cpu_seconds,frame_ms,gpu_mib >"$folder/soak.csv"
begin=$SECONDS
ticks=$(getconf CLK_TCK)
table=$folder/run/track.csv
while [ $((SECONDS - begin)) -lt $((60 * minutes)) ] && kill -0 "$run" 2>/dev/null; do
  sleep "$period"
  [ -r "$table" ] && [ -r "/proc/$run/stat" ] || continue
  frames=$(($(wc -l <"$table") - 1))
  milliseconds=$(tail -n 100 "$table" | awk -F, '$6 + 0 > 0 {print $6}' | sort -n | awk '{a[NR] = $1} END {print a[int((NR + 1) / 2)]}')
  cpu=$(awk -v ticks="$ticks" '{sub(/.*\) /, ""); print ($12 + $13) / ticks}' "/proc/$run/stat")
  echo "$((SECONDS - begin)),$frames,$(($(value VmRSS) / 1024)),$(ls "/proc/$run/fd" | wc -l),$(value Threads),$cpu,$milliseconds,$(gpu_memory)" \
    >>"$folder/soak.csv"
done
kill -TERM "$run" 2>/dev/null || true
code=0
wait "$run" || code=$?
trap - EXIT
case $code in
  0 | 130) ;;
  *) echo "soak.sh: the run ended with $code; $folder/log.txt says why" >&2; exit 1 ;;
esac
/usr/bin/python3 "$root/scripts/soak_plot.py" "$folder/soak.csv" "$folder/soak.svg"
