#!/usr/bin/env python3
"""Fits the weights of core/src/judge/weights.hpp to tables of collect_evidence.

    fit.py TABLE.csv... > core/src/judge/weights.hpp

A logistic regression says whether a model's landmarks are within 10 mm of the truth, against more than
20 mm or nothing there; what lies between is left out. A third of the tables is held out, and what the
weights say of those is printed to standard error.
"""
import csv
import sys

import numpy as np

RIGHT_MM, WRONG_MM = 10, 20
PENALTY = 3.0  # of the squared weights, for features of variance 1
APPEARANCE = {"inside", "ring", "worst_inside", "worst_ring"}  # unknown before anything was learned


def read(files):
    names, rows, table = None, [], []
    for number, file in enumerate(files):
        with open(file, newline="") as stream:
            reader = csv.reader(stream)
            header = next(reader)
            names = names or header
            for row in reader:
                if len(row) == len(header):
                    rows.append([float(x) for x in row[1:]])
                    table.append((number, row[0]))
    return names[1:], np.array(rows), np.array([t for t, _ in table]), np.array([k for _, k in table])


def fit(x, y, weight):
    """Newton's method on standardised features; returns bias and factors for raw ones."""
    mean, scale = x.mean(0), x.std(0)
    scale[scale < 1e-9] = np.inf
    z = np.hstack([np.ones((len(x), 1)), (x - mean) / scale])
    w = np.zeros(z.shape[1])
    ridge = np.full(len(w), PENALTY)
    ridge[0] = 1e-6
    for _ in range(50):
        p = 1 / (1 + np.exp(-z @ w))
        h = (z * (weight * p * (1 - p))[:, None]).T @ z + np.diag(ridge)
        step = np.linalg.solve(h, z.T @ (weight * (p - y)) + ridge * w)
        w -= step
        if np.abs(step).max() < 1e-8:
            break
    factors = w[1:] / scale
    return w[0] - factors @ mean, factors


def main():
    names, rows, table, kind = read(sys.argv[1:])
    column = {n: i for i, n in enumerate(names)}
    error, absent = rows[:, column["error"]], rows[:, column["absent"]] > 0
    known, experienced = rows[:, column["known"]] > 0, rows[:, column["experienced"]] > 0
    first = column["experienced"] + 1
    features, feature_names = rows[:, first:], names[first:]
    count = len(feature_names) // 2
    right, wrong = (error <= RIGHT_MM) & ~absent, (error > WRONG_MM) | absent
    shown = {}
    for label, chosen, allowed in (
        ("kFresh", ~experienced, [n not in APPEARANCE and not n.startswith("d_") for n in feature_names]),
        ("kExperienced", experienced, [True] * len(feature_names)),
    ):
        x = np.where(allowed, features, 0)
        # Answers of trackers are what is judged; displaced poses fill in what they lack.
        weight = np.where(kind == "tracker", 3.0, 1.0)
        usable = chosen & known & (right | wrong)
        held_out = table % 3 == 0
        train = usable & ~held_out
        bias, factors = fit(x[train], right[train].astype(float), weight[train])
        p = 1 / (1 + np.exp(-(bias + x @ factors)))
        for threshold in (0.3, 0.5, 0.7, 0.8, 0.9):
            tests = [("<=3", error <= 3), ("<=10", error <= 10), ("10-20", (error > 10) & (error <= 20)),
                     ("20-30", (error > 20) & (error <= 30)), ("30-50", (error > 30) & (error <= 50)),
                     (">50", error > 50)]
            cells = []
            for only in ("tracker", "displaced"):
                for name, range_ in tests + [("absent", absent)]:
                    m = chosen & held_out & range_ & (kind == only) & (absent if name == "absent" else ~absent)
                    if m.any():
                        cells.append(f"{only[:4]} {name} {(p[m] >= threshold).mean():.3f}/{m.sum()}")
            print(label, threshold, "; ".join(cells), file=sys.stderr)
        shown[label] = fit(x[usable], right[usable].astype(float), weight[usable])
    print("// Made by tools/fit_judge/fit.py; not to be changed by hand.\n#pragma once\n\n#include <array>\n")
    print('#include "judge/evidence.hpp"\n')
    print("/// Weights of logistic regressions over ModelJudge::features(): the probability that a model's\n"
          f"/// landmarks are within {RIGHT_MM} mm of where they are in truth, and not more than {WRONG_MM} mm off.\n"
          "namespace hypotrack::judge_weights {\n")
    print("struct Logistic {\n  double bias;\n  std::array<double, 2 * Evidence::kCount> factors;\n};\n")
    for label, comment in (("kFresh", "Before anything was learned."), ("kExperienced", "After that.")):
        bias, factors = shown[label]
        print(f"/// {comment}\ninline constexpr Logistic {label}{{\n    {bias:.5g},\n    {{{{")
        for name, value in zip(feature_names, factors):
            print(f"        {value:.5g},  // {name}")
        print("    }}};\n")
    print("}  // namespace hypotrack::judge_weights")


if __name__ == "__main__":
    main()
