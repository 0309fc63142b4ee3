#!/usr/bin/env bash
# Arguments of examples/slurm/try.sh. Exit code 77, which says skipped, where Slurm is not installed.
set -euo pipefail
for program in sbatch slurmctld slurmd munged; do
  if ! command -v "$program" >/dev/null; then
    echo "skipped: there is no $program; it comes with the Debian packages slurm-wlm and munge"
    exit 77
  fi
done
exec "$(dirname "${BASH_SOURCE[0]}")/../../../examples/slurm/try.sh" "$@"
