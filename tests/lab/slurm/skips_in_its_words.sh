#!/usr/bin/env bash
# Starts the cluster of the example with a slurmd that fails as one does without cgroups. Expects exit
# code 77 with slurmd's own words, and nothing left running.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in slurmctld munged; do
  command -v "$program" >/dev/null || { echo "skipped: there is no $program"; exit 77; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
printf '#!/bin/sh\necho "slurmd: fatal: cannot find cgroup plugin for cgroup/v2" >&2\nexit 1\n' >"$scratch/slurmd"
chmod +x "$scratch/slurmd"
code=0
said=$(PATH=$scratch:$PATH "$here/../../../examples/slurm/local_cluster.sh" start "$scratch/dir" 2>&1) || code=$?
[ "$code" -eq 77 ] || { echo "exit code $code, expected 77: $said"; exit 1; }
case $said in
  *"slurmd cannot run on this machine"*"cannot find cgroup plugin"*) ;;
  *) echo "expected slurmd's words, found: $said"; exit 1 ;;
esac
for pid in "$scratch"/dir/*.pid; do
  [ -e "$pid" ] || continue
  ! kill -0 "$(cat "$pid")" 2>/dev/null || { echo "still running: $pid"; exit 1; }
done
