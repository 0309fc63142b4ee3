#!/usr/bin/env python3
"""Draws the samples of soak.sh and says what drifts: soak_plot.py SOAK.csv SOAK.svg. Fails if anything does.

Compares the middle third of the samples with the last: a run may take memory at first, but must not go on."""
import csv
import sys
from statistics import median

# name, title, growth that is allowed: share, and units on top
QUANTITIES = [
    ("rss_mib", "memory, MiB", 0.03, 8),
    ("descriptors", "open files", 0, 2),
    ("threads", "threads", 0, 2),
    ("cpu_ms", "processor time of a frame, ms", 0.2, 2),
    ("gpu_mib", "GPU memory, MiB", 0.03, 8),
]
WIDTH, HEIGHT, LEFT, GAP = 720, 110, 60, 46


def read(file):
    rows = [{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(open(file))]
    for before, row in zip(rows, rows[1:]):
        frames = row["frames"] - before["frames"]
        if frames > 0:
            row["cpu_ms"] = 1000 * (row["cpu_seconds"] - before["cpu_seconds"]) / frames
    return rows


def series(rows, name):
    return [(row["seconds"], row[name]) for row in rows if name in row]


def panel(points, title, top):
    last, most = points[-1][0], 1.1 * max(v for _, v in points) or 1
    line = " ".join(f"{LEFT + WIDTH * t / last:.1f},{top + HEIGHT * (1 - v / most):.1f}" for t, v in points)
    return (
        f'<text x="{LEFT}" y="{top - 8}">{title}</text>'
        f'<text x="{LEFT - 6}" y="{top + 10}" text-anchor="end">{most:.3g}</text>'
        f'<text x="{LEFT - 6}" y="{top + HEIGHT}" text-anchor="end">0</text>'
        f'<text x="{LEFT + WIDTH}" y="{top + HEIGHT + 14}" text-anchor="end">{last / 60:.0f} min</text>'
        f'<path d="M{LEFT},{top}V{top + HEIGHT}H{LEFT + WIDTH}" fill="none" stroke="#818b98"/>'
        f'<polyline points="{line}" fill="none" stroke="#0969da" stroke-width="1.5"/>\n'
    )


def drift(points, share, units):
    """Returns the medians of the middle and the last third, and whether the second is too large."""
    third = len(points) // 3
    middle = median(v for _, v in points[third : 2 * third])
    last = median(v for _, v in points[-third:])
    return middle, last, last > middle * (1 + share) + units


def main():
    rows = read(sys.argv[1])
    if len(rows) < 9:
        sys.exit(f"soak_plot.py: {sys.argv[1]} has {len(rows)} samples, expected 9 or more; soak for longer")
    panels, failed = "", False
    top = GAP
    for name, title, share, units in QUANTITIES:
        points = series(rows, name)
        if len(points) < 9:
            continue
        middle, last, drifts = drift(points, share, units)
        failed = failed or drifts
        print(f"{title}: {middle:.4g} in the middle third, {last:.4g} in the last{': DRIFTS' if drifts else ''}")
        panels += panel(points, title, top)
        top += HEIGHT + GAP
    print(f"{rows[-1]['frames']:.0f} frames in {rows[-1]['seconds'] / 60:.0f} min; drawn in {sys.argv[2]}")
    with open(sys.argv[2], "w") as out:
        out.write(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 20}" height="{top}" '
            f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>\n{panels}</svg>\n'
        )
    sys.exit(failed)


main()
