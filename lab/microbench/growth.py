#!/usr/bin/env python3
"""Measures how a search's time grows with its size: growth.py HYPOTRACK SCENE OUT [--backend cuda]

Writes OUT/growth.csv and OUT/growth.svg: microseconds per hypothesis against the hypotheses of a generation of
`pso`, and milliseconds per Jacobian against the starts of `levenberg_marquardt`. Each is the difference of two
runs of `hypotrack bench`, so that what every frame takes anyway is left out.
"""
import argparse
import csv
import math
import pathlib
import subprocess
import tempfile

SWARMS = [64, 128, 256, 512, 1024, 2048, 4096, 8192]
STARTS = [1, 2, 4, 8, 16, 32, 64, 128, 256]
PLAIN = ["judge=none", "uncertainty.enabled=false", "budget.evaluations=0"]


def median_ms(options, optimizer):
    """Returns the median time of a frame with an optimizer."""
    with tempfile.TemporaryDirectory() as folder:
        rows = pathlib.Path(folder) / "rows.csv"
        command = [options.hypotrack, "bench", options.scene, "--backends", options.backend, "--frames", "12",
                   "--warm-up", "3", "--seconds", "4", "--out", rows]
        for change in [*PLAIN, f"optimizer={optimizer}"]:
            command += ["--set", change]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{optimizer}: {done.stderr}")
        with open(rows, newline="") as file:
            row = next(csv.DictReader(file))
    if not row["median_ms"]:
        raise SystemExit(f"{optimizer}: {row['message']}")
    return float(row["median_ms"])


def per_hypothesis_us(options, particles):
    few, many = (median_ms(options, f"{{type: pso, particles: {particles}, generations: {n}}}") for n in (4, 20))
    return 1000 * (many - few) / (16 * particles)


def per_jacobian_ms(options, starts):
    few, many = (median_ms(options, f"{{type: levenberg_marquardt, restarts: {starts}, iterations: {n}, "
                                    "evaluations: 1000000, finest: 0.001, tolerance: 0}") for n in (3, 7))
    return (many - few) / 4


def panel(points, left, title, x_label, y_label):
    """Draws one curve over logarithmic axes that end where the data ends."""
    width, height, top = 300, 220, 40
    xs = [math.log2(x) for x, _ in points]
    ys = [math.log10(y) for _, y in points]
    low, high = math.floor(min(ys)), max(math.ceil(max(ys)), math.floor(min(ys)) + 1)

    def place(x, y):
        return (left + (x - xs[0]) / (xs[-1] - xs[0]) * width, top + (high - y) / (high - low) * height)

    out = [f'<text class="title" x="{left}" y="20">{title}</text>',
           f'<rect class="frame" x="{left}" y="{top}" width="{width}" height="{height}"/>']
    for decade in range(low, high + 1):
        _, y = place(xs[0], decade)
        out.append(f'<path class="grid" d="M{left} {y:.1f}h{width}"/>'
                   f'<text text-anchor="end" x="{left - 6}" y="{y + 4:.1f}">{10.0 ** decade:g}</text>')
    for x, _ in points:
        at, _ = place(math.log2(x), low)
        out.append(f'<text text-anchor="middle" x="{at:.1f}" y="{top + height + 18}">{x}</text>')
    line = " ".join("{:.1f},{:.1f}".format(*place(x, y)) for x, y in zip(xs, ys))
    out.append(f'<polyline class="curve" points="{line}"/>')
    out += ['<circle class="dot" cx="{:.1f}" cy="{:.1f}" r="3"/>'.format(*place(x, y)) for x, y in zip(xs, ys)]
    out.append(f'<text text-anchor="middle" x="{left + width / 2}" y="{top + height + 38}">{x_label}</text>')
    out.append(f'<text x="{left}" y="{top - 6}">{y_label}</text>')
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("hypotrack")
    parser.add_argument("scene")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--backend", default="cuda")
    options = parser.parse_args()
    swarms = [(n, per_hypothesis_us(options, n)) for n in SWARMS]
    starts = [(n, per_jacobian_ms(options, n)) for n in STARTS]
    options.out.mkdir(parents=True, exist_ok=True)
    with open(options.out / "growth.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["optimizer", "size", "us_per_hypothesis", "ms_per_jacobian"])
        table.writerows(["pso", n, f"{us:.3f}", ""] for n, us in swarms)
        table.writerows(["levenberg_marquardt", n, "", f"{ms:.3f}"] for n, ms in starts)
    picture = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 780 310" width="780" height="310"><style>'
               "text{font:12px sans-serif;fill:#1f2328}.title{font-weight:600;font-size:14px}.frame{fill:none;stroke:#818b98}"
               ".grid{stroke:#d1d9e0}.curve{fill:none;stroke:#0969da;stroke-width:2}.dot{fill:#0969da}"
               '</style><rect width="780" height="310" fill="#fff"/>']
    picture += panel(swarms, 60, "A swarm", "hypotheses of a generation", "microseconds per hypothesis")
    picture += panel(starts, 450, "Least squares", "starts", "milliseconds per Jacobian of all")
    (options.out / "growth.svg").write_text("\n".join([*picture, "</svg>"]) + "\n")


if __name__ == "__main__":
    main()
