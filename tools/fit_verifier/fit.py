#!/usr/bin/env python3
"""Fits the weights of core/src/track/verify/weights.hpp to tables of collect_evidence.

    fit.py TABLE.csv... > core/src/track/verify/weights.hpp

A network with one hidden layer says whether a model's landmarks are within 10 mm of the truth, against
more than 20 mm or nothing there; what lies between is left out. A quarter of the tables is held out, and
what the weights say of those is printed to standard error. Needs python3-sklearn.
"""
import csv
import sys

import numpy as np
from sklearn.neural_network import MLPClassifier

RIGHT_MM, WRONG_MM = 10, 20
HIDDEN = 32
PENALTY = 0.3  # of the squared weights, for features of variance 1
COPIES = 3  # of what searches end at, which is what is judged; other poses fill in what they lack
LIKENESS = 9.0  # weight of the likeness of surfaces, chosen by hand; maximum likelihood gives 4 to 6
SEARCHED = ["tracker", "recovered"]
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


def fit(x, y, copies):
    """Trains the network; returns what weights.hpp has."""
    mean, scale = x.mean(0), x.std(0)
    scale[scale < 1e-9] = np.inf
    rows = np.repeat(np.arange(len(x)), copies)
    network = MLPClassifier((HIDDEN,), alpha=PENALTY, max_iter=600, random_state=1)
    network.fit(((x - mean) / scale)[rows], y[rows])
    (hidden, out), (hidden_bias, out_bias) = network.coefs_, network.intercepts_
    hidden = (hidden / scale[:, None]).T  # for raw features
    return hidden, hidden_bias - hidden @ mean, out[:, 0], out_bias[0]


def log_odds(weights, x):
    hidden, hidden_bias, out, out_bias = weights
    return np.maximum(x @ hidden.T + hidden_bias, 0) @ out + out_bias


def probability(odds):
    return 1 / (1 + np.exp(-odds))


def main():
    names, rows, table, kind = read(sys.argv[1:])
    column = {n: i for i, n in enumerate(names)}
    error, absent = rows[:, column["error"]], rows[:, column["absent"]] > 0
    known, experienced = rows[:, column["known"]] > 0, rows[:, column["experienced"]] > 0
    first = column["experienced"] + 1
    features, feature_names = rows[:, first:], names[first:]
    count = len(feature_names) // 2
    right, wrong = (error <= RIGHT_MM) & ~absent, (error > WRONG_MM) | absent
    usual, likeness = rows[:, column["usual_likeness"]], rows[:, column["likeness"]]
    likeness = np.where(experienced & ~np.isnan(likeness), usual * (likeness - usual), 0)
    shown = {}
    for label, chosen, allowed in (
        ("kFresh", ~experienced, [n not in APPEARANCE and not n.startswith("d_") for n in feature_names]),
        ("kExperienced", experienced, [True] * len(feature_names)),
    ):
        x = np.where(allowed, features, 0)
        copies = np.where(np.isin(kind, SEARCHED), COPIES, 1)
        usable = chosen & known & (right | wrong)
        held_out = table % 4 == 3
        train = usable & ~held_out
        odds = log_odds(fit(x[train], right[train], copies[train]), x) + LIKENESS * likeness
        p = probability(odds)
        for threshold in (0.3, 0.5, 0.7, 0.8, 0.9):
            tests = [("<=3", error <= 3), ("<=10", error <= 10), ("10-20", (error > 10) & (error <= 20)),
                     ("20-30", (error > 20) & (error <= 30)), ("30-50", (error > 30) & (error <= 50)),
                     (">50", error > 50)]
            cells = []
            for only in ("tracker", "recovered", "displaced"):
                for name, range_ in tests + [("absent", absent)]:
                    m = chosen & held_out & range_ & (kind == only) & (absent if name == "absent" else ~absent)
                    if m.any():
                        cells.append(f"{only[:4]} {name} {(p[m] >= threshold).mean():.3f}/{m.sum()}")
            print(label, threshold, "; ".join(cells), file=sys.stderr)
        shown[label] = fit(x[usable], right[usable], copies[usable])
    print("// Made by tools/fit_verifier/fit.py; not to be changed by hand.\n#pragma once\n\n#include <array>\n")
    print('#include "base/exported.hpp"\n#include "track/verify/evidence.hpp"\n')
    print("/// Weights of networks over ModelVerifier::features(): how likely a model's landmarks are within\n"
          f"/// {RIGHT_MM} mm of where they are in truth, and not more than {WRONG_MM} mm off.\n"
          "namespace hypotrack::verifier_weights {\ninline namespace HYPOTRACK_EXPORTED internal {\n")
    print(f"inline constexpr int kHidden = {HIDDEN};\n")
    print("/// One hidden layer of rectified linear units; the output is the logarithm of the odds.\n"
          "struct Network {\n"
          "  std::array<std::array<double, 2 * Evidence::kCount>, kHidden> hidden;\n"
          "  std::array<double, kHidden> hidden_bias;\n"
          "  std::array<double, kHidden> out;\n"
          "  double out_bias;\n};\n")
    numbers = lambda values: ", ".join(f"{v:.5g}" for v in values)
    for label, comment in (("kFresh", "Before anything was learned."), ("kExperienced", "After that.")):
        hidden, hidden_bias, out, out_bias = shown[label]
        print(f"/// {comment}\ninline constexpr Network {label}{{{{{{")
        for row in hidden:
            print(f"{{{{{numbers(row)}}}}},")
        print(f"}}}}, {{{{{numbers(hidden_bias)}}}}}, {{{{{numbers(out)}}}}}, {out_bias:.5g}}};\n")
    print("/// Of the usual likeness times its difference to the likeness.\n"
          f"inline constexpr double kLikeness = {LIKENESS:.2g};\n")
    print("}  // namespace internal\n}  // namespace hypotrack::verifier_weights")


if __name__ == "__main__":
    main()
