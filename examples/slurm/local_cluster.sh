#!/usr/bin/env bash
# A real Slurm on this machine alone, to try array jobs with: slurmctld, slurmd and munged, with all
# of their state in one folder, as the user who starts them, without systemd. Needs the Debian packages
# slurm-wlm and munge.
#
#   examples/slurm/local_cluster.sh start DIR [NODES]     then: export SLURM_CONF=DIR/slurm.conf
#   examples/slurm/local_cluster.sh stop DIR
#
# NODES nodes (default: 1) share the processors; each has a slurmd of its own.
# Exit code 77 of start: a service cannot run here, as without cgroups; its own words are printed.
set -euo pipefail

usage() {
  sed -n '2,10s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

free_port() {  # the first of $1 ports that nobody listens on
  local port i
  while true; do
    port=$((20000 + RANDOM))
    for ((i = port; i < port + $1; i++)); do
      ! (exec 3<>"/dev/tcp/127.0.0.1/$i") 2>/dev/null || continue 2
    done
    break
  done
  echo "$port"
}

write_conf() {
  local port cpus
  port=$(free_port "$nodes") cpus=$(($(nproc) / nodes))
  cat >"$dir/slurm.conf" <<CONF
ClusterName=local
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port 1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd_%n.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd_%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName=node[1-$nodes] NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=[$port-$((port + nodes - 1))] CPUs=$((cpus > 0 ? cpus : 1))
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
  local i
  service slurmctld -c || return 77
  for ((i = 1; i <= nodes; i++)); do
    mkdir -p "$dir/spool/node$i"
    service slurmd_node$i -N node$i || return 77
  done
  for _ in $(seq 100); do
    [ "$(sinfo --noheader --format='%t %D' 2>/dev/null)" = "idle $nodes" ] && return 0
    sleep 0.2
  done
  cannot_run slurmd_node1
  return 77
}

service() {  # service NAME [OPTION...]: starts slurmctld or slurmd, whose files have NAME
  "${1%%_*}" "${@:2}" 2>"$dir/stderr.log" || { cannot_run "$1"; return 77; }
  # A service writes its number after it has gone to the background, and stop needs that.
  for _ in $(seq 100); do
    [ -s "$dir/$1.pid" ] && break
    sleep 0.1
  done
}

cannot_run() {  # says so in the service's own words
  echo "${1%%_*} cannot run on this machine:" >&2
  cat "$dir/stderr.log" "$dir/$1.log" 2>/dev/null | grep -E 'error|fatal' | tail -n 3 >&2 || true
}

stop() {
  local name pid
  for name in "$dir"/slurmd_*.pid "$dir/slurmctld.pid" "$dir/munged.pid"; do
    pid=$(cat "$name" 2>/dev/null) || continue
    kill "$pid" 2>/dev/null || continue
    for _ in $(seq 100); do
      kill -0 "$pid" 2>/dev/null || break
      sleep 0.1
    done
  done
}

[ $# -eq 2 ] || [ "${1:-} $#" = "start 3" ] || usage
nodes=${3:-1}
[[ $nodes =~ ^[1-9][0-9]?$ ]] || usage
mkdir -p "$2"
dir=$(cd "$2" && pwd)
case $1 in
  start) start || { code=$?; stop; exit "$code"; } ;;
  stop) stop ;;
  *) usage ;;
esac
