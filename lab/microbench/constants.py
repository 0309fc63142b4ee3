#!/usr/bin/env python3
"""Measures what each constant of the tracker earns, on sequences that show whether the tracker is right.

    constants.py rewrite COPY [--keep NAME ...] > NAMES    in a copy of the sources: the environment scales constants
    constants.py run HYPOTRACK OUT --names NAMES           the program of that copy; runs configs/studies/constants.yaml

`rewrite` prints the constants' names: file:NAME, and file:NAME:2 for the second of that name. Build the copy; in a fresh
one, name with --keep the constants that the compiler insists on. `run`
scales each constant to nothing and to a thousand times itself, and writes OUT/constants.csv: whether that changes a metric
of any sequence, and makes it worse than in unscaled runs with other noise. Run again, it goes on.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess

VARIABLE = "HYPOTRACK_SCALED"
TYPE = r"(?:double|float|int|unsigned|std::size_t|std::ptrdiff_t|std::int\d+_t|Eigen::Index)"
STATEMENT = re.compile(rf"^([ \t]*)((?:static |inline )*)constexpr ({TYPE}) (k[A-Z][^;{{}}]*);", re.M)
HEADER = f"""\
#pragma once
#include <cstdlib>
#include <cstring>
#include <string_view>
namespace {{
template <class T>
[[maybe_unused]] T scaled(const char* name, T value) {{
  const char* wanted = std::getenv("{VARIABLE}");
  const char* equals = wanted ? std::strchr(wanted, '=') : nullptr;
  if (!equals || std::string_view(wanted, equals) != name) return value;
  return static_cast<T>(static_cast<double>(value) * std::atof(equals + 1));
}}
}}
"""
FACTORS = ["0", "1000"]
SEEDS = 3
VARIANTS = ["color", "faults", "occlude", "rig", "search", "smooth"]
# Metrics, 1 if more is worse, and what they may change: millimetres by a share, shares by a difference.
METRICS = {"mean_error_mm": (1, 0.05), "max_error_mm": (1, 0.3), "lost_share": (1, 0.02), "tracked_share": (-1, 0.02),
           "false_tracked_share": (1, 0.02), "right_tracked_share": (-1, 0.02), "absent_tracked_share": (1, 0.02),
           "recovered_10_share": (-1, 0.02), "missing_frames": (1, 0)}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    rewriting = commands.add_parser("rewrite")
    rewriting.add_argument("copy", type=pathlib.Path)
    rewriting.add_argument("--keep", nargs="*", default=[])
    running = commands.add_parser("run")
    running.add_argument("hypotrack", type=pathlib.Path)
    running.add_argument("out", type=pathlib.Path)
    running.add_argument("--names", type=pathlib.Path, required=True, help="file with what `rewrite` printed")
    running.add_argument("--study", type=pathlib.Path,
                         default=pathlib.Path(__file__).parents[2] / "configs/studies/constants.yaml")
    running.add_argument("--jobs", type=int, default=os.cpu_count())
    running.add_argument("--time-limit", type=int, default=120, help="seconds of a sequence")
    return parser.parse_args()


def declarators(text):
    """Yields NAME, VALUE of `kA = 1, kB = f(2, 3)`."""
    depth, begin = 0, 0
    text = re.sub(r"//[^\n]*", "", text) + ","
    for at, c in enumerate(text):
        depth += (c == "(") - (c == ")")
        if c == "," and depth == 0:
            name, value = text[begin:at].split("=", 1)
            yield name.strip(), value.strip()
            begin = at + 1


def rewrite(folder, keep):
    """Makes constants of core/src/track variables; returns their names."""
    names = []
    for path in sorted(folder.rglob("*.[ch]pp")):
        text, file = path.read_text(encoding="utf-8"), str(path.relative_to(folder))
        count = collections.Counter()

        def variables(match):
            indent, words, kind, rest = match.groups()
            parts = []
            for name, value in declarators(rest):
                count[name] += 1
                parts.append((name, value, f"{file}:{name}" + (f":{count[name]}" if count[name] > 1 else "")))
            if any(full in keep for _, _, full in parts):
                return match[0]
            names.extend(full for _, _, full in parts)
            words = words if path.suffix == ".hpp" and words else "static "
            words += "inline " if path.suffix == ".hpp" and words == "static " and "static" in match[2] else ""
            return (f"{indent}{words}const {kind} "
                    + ", ".join(f'{name} = ::scaled<{kind}>("{full}", ({value}))' for name, value, full in parts) + ";")

        new = STATEMENT.sub(variables, text)
        if new != text:
            path.write_text('#include "track/scaled.hpp"\n' + new, encoding="utf-8")
    (folder / "scaled.hpp").write_text(HEADER, encoding="utf-8")
    return names


def call(options, log, *words, scaled=""):
    """Runs the program with a constant scaled; returns whether it ended well and in time."""
    with open(log, "w", encoding="utf-8") as file:
        try:
            return subprocess.run([options.hypotrack, *words], env={**os.environ, VARIABLE: scaled}, check=False,
                                  stdout=file, stderr=file, timeout=options.time_limit if scaled else None).returncode == 0
        except subprocess.TimeoutExpired:
            return False


def track(options, scene, name, scaled=""):
    """Tracks a recording; returns its metrics, or nothing after a failure."""
    out = options.out / name
    shutil.rmtree(out, ignore_errors=True)
    done = call(options, options.out / f"{name}.log", "run", scene, "--out", out, "--set", "evaluate.threads=1",
                scaled=scaled)
    metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8")) if done else {}
    shutil.rmtree(out, ignore_errors=True)
    return {name: metrics[name] for name in METRICS if metrics.get(name) is not None}


def record(options, scene, recording):
    """Renders a scene."""
    part = recording.with_suffix(".part")
    shutil.rmtree(part, ignore_errors=True)  # of a run that was stopped
    if call(options, f"{recording}.log", "synth", scene, "--format", "ppm", "--out", part):
        part.rename(recording)


def base(options, pool, variant):
    """Makes a variant's recordings; returns by sequence its scene, its metrics and those of runs with other noise."""
    out, log = options.out / variant, options.out / f"{variant}.log"
    file = options.out / f"{variant}.yaml"
    file.write_text(f'extends: "@{options.study.resolve()}"\nseeds: {SEEDS}\n', encoding="utf-8")
    if not call(options, log, "compare", file, "--variant", variant, "--out", out, "--threads", "1",
                "--jobs", str(options.jobs)):
        raise SystemExit(f"the study fails: {log}")
    (out / "recordings").mkdir(exist_ok=True)
    sequences, recorded = {}, {}
    for run in sorted((out / "runs").iterdir()):
        cell = json.loads((run / "cell.json").read_text(encoding="utf-8"))
        metrics = json.loads((run / "metrics.json").read_text(encoding="utf-8"))
        sequences.setdefault(cell["scene"], []).append(metrics)
        if cell["seed"] == 1:
            recorded[cell["scene"]] = recording = out / "recordings" / cell["scene"]
            if not recording.exists():
                pool.submit(record, options, run / "run.yaml", recording)
    return sequences, recorded


def worse(scene, metrics, draws):
    """Returns the first metric that is worse than in all runs with other noise, as text; empty: none."""
    if not metrics:
        return f"{scene} ends without metrics"
    for metric, (sign, tolerance) in METRICS.items():
        values = [draw[metric] for draw in draws if draw.get(metric) is not None]
        if metric not in metrics or not values:
            continue
        most = max(sign * value for value in values)
        if sign * metrics[metric] > most + (tolerance * most if metric.endswith("_mm") else tolerance):
            return f"{scene} {metric} {metrics[metric]:.3g} ({min(values):.3g} to {max(values):.3g})"
    return ""


def without(options, bases, name, factor):
    """Returns the row of a constant scaled by a factor."""
    variant = name.split("/")[0] if name.split("/")[0] in bases else "search"
    effects, same = [], True
    for scene, (recording, plain, draws) in bases[variant].items():
        metrics = track(options, recording, f"{name}_{factor}_{scene}".replace("/", "."), f"{name}={factor}")
        same = same and metrics == plain
        effects.append(worse(scene, metrics, [plain, *draws]))
    where = "; ".join(filter(None, effects))
    effect = "none" if same else "worse" if where else "within noise"
    return {"constant": name, "factor": factor, "effect": effect, "where": where}


def run(options):
    names = options.names.read_text(encoding="utf-8").split()
    folders = sorted({name.split("/")[0] for name in names} & set(VARIANTS) | {"search"})
    options.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        made = {variant: base(options, pool, variant) for variant in folders}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        plain = {(variant, scene): pool.submit(track, options, recording / "scene.yaml", f"{variant}_{scene}")
                 for variant, (_, recorded) in made.items() for scene, recording in recorded.items()}
    bases = {variant: {scene: (recording / "scene.yaml", plain[variant, scene].result(), draws[scene])
                       for scene, recording in recorded.items()} for variant, (draws, recorded) in made.items()}
    done = set()
    if (table := options.out / "constants.csv").exists():
        with open(table, newline="", encoding="utf-8") as file:
            done = {(row["constant"], row["factor"]) for row in csv.DictReader(file)}
    works = [(name, factor) for name in names for factor in FACTORS if (name, factor) not in done]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, \
            open(table, "a", newline="", encoding="utf-8") as file:
        for work in concurrent.futures.as_completed([pool.submit(without, options, bases, *one) for one in works]):
            row = work.result()
            writer = csv.DictWriter(file, row)
            if file.tell() == 0:
                writer.writeheader()
            writer.writerow(row)
            file.flush()


def main():
    options = arguments()
    if options.command == "rewrite":
        print("\n".join(rewrite(options.copy / "core/src/track", set(options.keep))))
    else:
        run(options)


if __name__ == "__main__":
    main()
