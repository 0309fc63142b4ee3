#!/bin/bash
# A worker (run/crew/) that does what files in $PLAN say, by GPU or by key of a job:
#   absent_GPU  its GPU does not answer        hold_GPU   it takes that many jobs before it acts
#   lose_GPU    its GPU fails, and is absent   fault_KEY  its GPU fails, and answers again
#   silent_GPU it never answers               exit_GPU   it ends when that file is removed
#   crash_KEY   the run ends the process       overdue_KEY, wait_KEY, fail_KEY  of a run
# It appends to $PLAN/log: the GPU, the job's key and the device that the job's settings name.
if [ "$1" = run ]; then
  echo "cpu $2" >>"$PLAN/log"
  echo "alone $2"
  exit 0
fi
gpu=${!#}
say() { echo "{\"kind\":\"$1\",\"text\":\"$2\",\"key\":${3:-0},\"code\":${4:-0}}" >&3; }
absent() { say absent 'it fell off the bus'; exit; }
[ -e "$PLAN/absent_$gpu" ] && absent
if [ -e "$PLAN/silent_$gpu" ]; then
  echo "$gpu silent" >>"$PLAN/log"
  exec sleep 100
fi
say ready "model $gpu"
if [ -e "$PLAN/exit_$gpu" ]; then
  while [ -e "$PLAN/exit_$gpu" ]; do sleep 0.01; done
  exit 3
fi
held=()
act() {
  local key=$1
  if [ -e "$PLAN/crash_$key" ]; then
    echo "hypotrack: frame 3: optimizer 'x': crashed" >&2
    kill -SEGV $$
  fi
  if [ -e "$PLAN/lose_$gpu" ]; then
    mv "$PLAN/lose_$gpu" "$PLAN/absent_$gpu"
    say lost '' "$key"
  elif [ -e "$PLAN/fault_$key" ]; then
    say lost '' "$key"
  elif [ -e "$PLAN/overdue_$key" ]; then
    say overdue '' "$key" 130
  elif [ -e "$PLAN/fail_$key" ]; then
    say ended '' "$key" 1
  elif [ ! -e "$PLAN/wait_$key" ]; then
    say ended '' "$key" 0
  fi
}
while IFS= read -r line <&3; do
  key=${line#*\"key\":} && key=${key%%,*}
  device=${line#*evaluate.device=} && device=${device%%\"*}
  echo "$gpu $key $device" >>"$PLAN/log"
  held+=("$key")
  count=1
  [ -e "$PLAN/hold_$gpu" ] && count=$(<"$PLAN/hold_$gpu")
  [ "${#held[@]}" -lt "$count" ] && continue
  rm -f "$PLAN/hold_$gpu"
  for each in "${held[@]}"; do act "$each"; done
  held=()
done
