#!/usr/bin/env bash
# Runs a study once on this machine and once through a Slurm that is set up for the purpose, and compares
# the tables byte by byte.
#
#   examples/slurm/try.sh STUDY [options of hypotrack compare, for example --variant smoke]
# Exit code 77: Slurm cannot run on this machine. After a failure the logs stay.
#
# HYPOTRACK names the program (default: hypotrack on the PATH), TASKS the size of the array (2).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -lt 1 ]; then
  sed -n '2,8s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
export HYPOTRACK=${HYPOTRACK:-hypotrack}
study=$1
shift
scratch=$(mktemp -d)
finish() {
  code=$?
  "$here/local_cluster.sh" stop "$scratch/slurm"
  case $code in
    0 | 77) rm -rf "$scratch" ;;
    *) echo "the logs are in $scratch" >&2 ;;
  esac
}
trap finish EXIT

echo "== on this machine"
"$HYPOTRACK" compare "$study" --out "$scratch/local" "$@"

echo "== as an array of ${TASKS:-2} tasks"
"$here/local_cluster.sh" start "$scratch/slurm"
export SLURM_CONF=$scratch/slurm/slurm.conf
sbatch --wait --array="1-${TASKS:-2}" --cpus-per-task=1 --output="$scratch/task_%a.log" \
  "$here/compare.sbatch" "$study" "$scratch/cluster" "$@" || failed=$?
tail -n 3 "$scratch"/task_*.log
[ "${failed:-0}" -eq 0 ] || exit "$failed"

for table in results.csv cells.csv; do
  cmp "$scratch/local/$table" "$scratch/cluster/$table"
  echo "the same on this machine and on the cluster: $table, $(($(wc -l <"$scratch/local/$table") - 1)) rows"
done
