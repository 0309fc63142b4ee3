#!/usr/bin/env bash
# A real Slurm on this machine alone, to try array jobs with: slurmctld, slurmd and munged, with all
# of their state in one folder, as the user who starts them, without systemd. Needs the Debian packages
# slurm-wlm and munge.
#
#   examples/slurm/local_cluster.sh start DIR     then: export SLURM_CONF=DIR/slurm.conf
#   examples/slurm/local_cluster.sh stop DIR
#
# Exit code 77 of start: a service cannot run here, as without cgroups; its own words are printed.
set -euo pipefail

usage() {
  sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

free_port() {  # one that nobody listens on
  local port
  while true; do
    port=$((20000 + RANDOM))
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}

write_conf() {
  cat >"$dir/slurm.conf" <<CONF
ClusterName=local
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES State=UP
CONF
}

start() {
  mkdir -p "$dir"/{state,spool}
  chmod 700 "$dir"
  dd if=/dev/urandom of="$dir/munge.key" bs=128 count=1 status=none
  chmod 600 "$dir/munge.key"
  munged --force --socket="$dir/munge.socket" --key-file="$dir/munge.key" \
    --pid-file="$dir/munged.pid" --seed-file="$dir/munge.seed" --log-file="$dir/munged.log"
  write_conf
  export SLURM_CONF=$dir/slurm.conf
  local program
  for program in "slurmctld -c" slurmd; do
    $program 2>"$dir/stderr.log" || { cannot_run "${program%% *}"; return 77; }
    # A service writes its number after it has gone to the background, and stop needs that.
    for _ in $(seq 100); do
      [ -s "$dir/${program%% *}.pid" ] && break
      sleep 0.1
    done
  done
  for _ in $(seq 100); do
    [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ] && return 0
    sleep 0.2
  done
  cannot_run slurmd
  return 77
}

cannot_run() {  # says so in the service's own words
  echo "$1 cannot run on this machine:" >&2
  cat "$dir/stderr.log" "$dir/$1.log" 2>/dev/null | grep -E 'error|fatal' | tail -n 3 >&2 || true
}

stop() {
  local name pid
  for name in slurmd slurmctld munged; do
    pid=$(cat "$dir/$name.pid" 2>/dev/null) || continue
    kill "$pid" 2>/dev/null || continue
    for _ in $(seq 100); do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
  done
}

[ $# -eq 2 ] || usage
mkdir -p "$2"
dir=$(cd "$2" && pwd)
case $1 in
  start) start || { code=$?; stop; exit "$code"; } ;;
  stop) stop ;;
  *) usage ;;
esac
