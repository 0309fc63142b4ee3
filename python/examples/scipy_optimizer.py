"""Tracks with an optimizer of scipy: differential evolution, whole generations at once.

    scipy_optimizer.py SCENE.yaml [FRAMES]

Prints the error of each frame, where the scene's source knows the truth.
"""

import sys

import numpy as np
from scipy.optimize import differential_evolution

import hypotrack


@hypotrack.plugin("optimizer", "scipy_evolution")
class Evolution:
    default_evaluations = 3000

    def __init__(self, population: int = 150, reach: float = 1.0):
        self.population, self.reach = population, reach  # reach: half a box, in spreads

    def minimize(self, cost, region, budget, seed):
        lower = np.maximum(region.lower, region.start - self.reach * region.spread)
        upper = np.minimum(region.upper, region.start + self.reach * region.spread)
        random = np.random.default_rng(seed)
        first = random.normal(region.start, self.reach / 3 * region.spread,
                              (self.population, cost.dimension))
        differential_evolution(
            lambda points: cost(points.T),  # scipy has points in columns, hypotrack in rows
            np.column_stack([lower, upper]), init=np.clip(first, lower, upper), seed=random,
            vectorized=True, updating="deferred", maxiter=10**6, polish=False,
            x0=region.start, mutation=(0.3, 0.7))
        # The budget ends the search, by hypotrack.BudgetSpent; the best point is the answer.


if __name__ == "__main__":
    scene, frames = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else None
    session = hypotrack.Session(scene, set={"optimizer": {"type": "scipy_evolution"},
                                            "budget": {}, "search.rotation_as": "tangent"})
    session.run(frames=frames, say=print, on_frame=lambda frame, solution, error: print(
        f"frame {frame.index}: {solution.status.name}, {1000 * error:.1f} mm off, "
        f"{solution.evaluations} evaluations"))
