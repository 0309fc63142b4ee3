#!/usr/bin/env bash
# Runs a study once on this machine and once through a Slurm that is set up for the purpose, and compares
# the tables byte by byte.
#
#   examples/slurm/try.sh STUDY [options of hypotrack compare, for example --variant smoke]
# Exit code 77: Slurm cannot run on this machine. After a failure the logs stay.
#
# HYPOTRACK names the program (default: hypotrack on the PATH), TASKS the size of the array, NODES the number of
# nodes (both 2).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -lt 1 ]; then
  sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
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

echo "== as an array of ${TASKS:-2} tasks on ${NODES:-2} nodes"
"$here/local_cluster.sh" start "$scratch/slurm" "${NODES:-2}"
export SLURM_CONF=$scratch/slurm/slurm.conf
# --exclusive: a node has one task at a time, so that every node gets some.
sbatch --wait --exclusive --array="1-${TASKS:-2}" --cpus-per-task=1 --output="$scratch/task_%a.log" \
  "$here/compare.sbatch" "$study" "$scratch/cluster" "$@" || failed=$?
tail -n 3 "$scratch"/task_*.log
[ "${failed:-0}" -eq 0 ] || exit "$failed"
used=$(sed -n 's/^shard .* on //p' "$scratch"/task_*.log | sort -u | paste -sd ' ')
echo "nodes with a share: $used"
if [ "${TASKS:-2}" -ge "${NODES:-2}" ] && [ "$(wc -w <<<"$used")" -ne "${NODES:-2}" ]; then
  echo "expected a share on each of ${NODES:-2} nodes" >&2
  exit 1
fi

for table in results.csv cells.csv; do
  cmp "$scratch/local/$table" "$scratch/cluster/$table"
  echo "the same on this machine and on the cluster: $table, $(($(wc -l <"$scratch/local/$table") - 1)) rows"
done
