#!/usr/bin/env bash
# Mean joint error of the paper's method over particles x generations:
#
#   lab/microbench/budgets.sh SCENE...        (SEEDS=5, BUDGETS="16 32 64", HYPOTRACK=build/release/bin/hypotrack)
#
# Renders each scene once, then tracks the recording with every budget N x N and seed; prints one line per scene and
# budget.
set -euo pipefail
hypotrack=${HYPOTRACK:-build/release/bin/hypotrack}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

value() { grep -o "\"$1\": [^,]*" "$2" | cut -d' ' -f2; }

echo "scene                budget   error mm: mean of seeds (each seed)          lost frames   frames/s"
for scene in "$@"; do
  name=$(basename "$scene" .yaml)
  "$hypotrack" synth "$scene" --out "$scratch/$name" >"$scratch/log" 2>&1
  for n in ${BUDGETS:-16 32 64}; do
    errors=() fps=() lost=0
    for seed in $(seq "${SEEDS:-5}"); do
      "$hypotrack" run "$scratch/$name/scene.yaml" --out "$scratch/run" --seed "$seed" \
        --set output.overlay=false --set 'objective={type: stereo_color}' --set photometric.match=false --set judge=none \
        --set "optimizer={type: pso, particles: $n, generations: $n}" \
        --set 'search={rotation_as: quaternion}' --set budget.evaluations=0 --set tile.size=128 \
        >"$scratch/log" 2>&1
      errors+=("$(value mean_joint_error_mm "$scratch/run/summary.json")")
      fps+=("$(value fps "$scratch/run/summary.json")")
      lost=$((lost + $(value lost_frames "$scratch/run/summary.json")))
    done
    printf '%s\n' "${errors[@]}" | awk -v name="$name" -v n="$n" -v lost="$lost" \
      -v fps="${fps[*]}" '
      { sum += $1; each = each sprintf(" %.1f", $1) }
      END { count = split(fps, f, " "); for (i in f) speed += f[i] / count
            printf "%-20s %2dx%-2d    %6.2f (%s )   %5d   %8.1f\n", name, n, n, sum / NR, each, lost, speed }'
  done
done
