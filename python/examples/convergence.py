"""Plots how searches of several optimizers converge.

    convergence.py SCENE.yaml PICTURE.svg [SEEDS]

Every search begins 15 mm and 8 degrees off the truth of the first frame, in directions of its seed.
"""

import csv
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hypotrack

# %% What is compared: overrides of the scene.
OPTIMIZERS = {
    "particle swarm": {"type": "pso", "particles": 64, "generations": 30},
    "random search": {"type": "random_search"},
    "CMA-ES": {"type": "cma_es"},
}
EVALUATIONS = 1920


# %% A run writes trace.csv: a row for each batch of each search.
def trace_of(scene, optimizer, seed):
    """Returns, for a search, the evaluations and the lowest cost above that of the truth."""
    with tempfile.TemporaryDirectory() as folder:
        hypotrack.Session(scene, set={
            "optimizer": optimizer, "budget": {"evaluations": EVALUATIONS}, "seed": seed,
            "init.from": "truth", "init.away_mm": 15, "init.away_deg": 8, "search.second_search": 0,
            "judge": "none", "output.trace": True, "output.overlay": False,
        }).run(folder, frames=1)
        with open(Path(folder) / "trace.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["search"] == "0"]
    return np.array([(int(row["evaluations"]), float(row["cost"]) - float(row["truth_cost"]))
                     for row in rows])


# %% The median over the searches, at the same numbers of evaluations.
def main(scene, picture, seeds=5):
    at = np.geomspace(30, EVALUATIONS, 60)
    for name, optimizer in OPTIMIZERS.items():
        searches = [trace_of(scene, optimizer, seed) for seed in range(seeds)]
        curves = [np.interp(at, s[:, 0], s[:, 1]) for s in searches]
        plt.plot(at, np.median(curves, axis=0), label=name)
        print(f"{name}: {len(searches)} searches, {np.median(curves, axis=0)[-1]:.4g} at the end")
    plt.xscale("log")
    plt.xlabel("evaluations")
    plt.ylabel("cost above that of the truth")
    plt.legend()
    plt.savefig(picture)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 5)
