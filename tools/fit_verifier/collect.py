#!/usr/bin/env python3
"""Collects the evidence that fit.py takes: a table per rendered sequence, drawn from a seed.

    scripts/get_photographs.sh
    collect.py build/dev/bin/collect_evidence TABLES [--jobs 2] [--video handpose3d/media]

The sequences differ in motion, absences, cameras, light, noise, background, forearm and in the hand's
shape. In half of them that is not the model's. Tables that are there already are kept.

The video is that of configs/scenes/two_webcams.yaml. two_webcams_poses.csv has the poses that the tracker found in
126 of its frames, with earlier weights. Some 55 of them were checked in pictures.

The weights that are committed come from tables that were cut short: all 72 ran side by side on 32 cores for
nine minutes, and had 85,000 rows then. Whole tables give other weights.
"""
import argparse
import concurrent.futures
import pathlib
import random
import subprocess
import sys

SEQUENCES = 72
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
SCENES = CONFIGS / "scenes"
PHOTOGRAPHS = ["aloeL.jpg", "fruits.jpg", "graf1.png", "home.jpg", "leuvenA.jpg", "stuff.jpg"]
BASELINES_MM = [60, 90, 120, 120, 120, 180, 250, 350]
KINDS = ["hand", "hand", "object", "hand", "hand", "two_hands", "hand", "webcams", "hand"]


def flow(value):
    """Writes a value as YAML in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def pictures(draw, number):
    """Draws how a sequence is taken and lit, and what stands behind the hand."""
    width, height, focal = draw.choice([(1280, 720, 700), (1280, 720, 950), (640, 480, 520)])
    background = {"kind": "image", "file": CONFIGS / "photographs" / draw.choice(PHOTOGRAPHS)}
    if draw.random() < 0.25:
        background = {"kind": "procedural", "seed": number}
    return {
        "source.cameras": {"width": width, "height": height, "focal_px": focal,
                           "baseline_mm": draw.choice(BASELINES_MM)},
        "source.background": background,
        "source.light": {"ambient": draw.uniform(0.4, 0.9), "diffuse": draw.uniform(0, 0.6),
                         "specular": draw.choice([0.0, 0.05, 0.12]),
                         "direction": [draw.uniform(-1, 1), draw.uniform(0, 1), 0.8]},
        "source.sensor": {"noise_sigma": draw.choice([1, 2, 3, 4]), "seed": number,
                          "gain": [1, draw.uniform(0.88, 1.12)], "blur_px": draw.choice([0, 0, 0.8, 1.5])},
        "source.forearm.kind": draw.choice(["none", "bare", "sleeve"]),
    }


def motion(draw, number, frames):
    """Draws a random motion with absences, source.random of a scene."""
    return {"seed": 9000 + number, "frames": frames, "speed_mm_per_s": draw.choice([200, 300, 500]),
            "turn_deg_per_s": draw.choice([90, 120, 250]), "gesture_s": draw.choice([0.3, 0.5, 0.7]),
            "tilt_deg": draw.choice([50, 70, 90]), "absence": {"after": 15, "frames": [1, 6]}}


def other_hand(draw):
    """Draws the shape of a rendered hand that is not the model's."""
    return {"scale": draw.uniform(0.93, 1.07), "finger_scale": [draw.uniform(0.9, 1.1)]}


def sequence(number, frames):
    """Returns a scene and its overrides."""
    draw = random.Random(number)
    kind, moved = KINDS[number % len(KINDS)], motion(draw, number, frames)
    settings = {"evaluate.backend": "cpu", "evaluate.threads": 1, "source.keyframes": "null",
                **pictures(draw, number)}
    tracker, other_shape = draw.choice(["demo", "demo", "real_time"]), number % 2 == 1
    settings["budget.evaluations"] = 32 if tracker == "real_time" else 1024
    if kind == "two_hands":
        tracker = "two_hands"
        moved |= {"tilt_deg": 50, "apart_mm": 180, "lowest_mm": [-160, 0, 480], "highest_mm": [280, 180, 700]}
        settings["source.gesture_file"] = SCENES / "datasets/gestures.yaml"
        if other_shape:
            right = {"type": "hand", **other_hand(draw)}
            settings["source.render_models"] = {"right": right, "left": {"type": "mirrored_hand", "of": right}}
    elif other_shape:
        settings["source.render_models"] = {"hand": {"type": "hand", **other_hand(draw)}}
    if kind == "object":
        moved |= {"gestures": ["around", "looser"], "tilt_deg": 40, "hold": {"box": "hand"},
                  "pose": {"hand": {"position_mm": [60, 70, 560], "rotation_deg": [180, 0, 0]},
                           "box": {"position_mm": [65, -10, 521.6], "rotation_deg": [180, 0, 0]}}}
    if kind == "webcams":  # half a metre apart, 44 degrees between their axes
        del settings["source.cameras"]
        settings["source.calibration"] = {"file": CONFIGS / "cameras/two_webcams.yaml", "scale": 0.04}
        moved |= {"lowest_mm": [-70, -60, 560], "highest_mm": [60, 60, 720]}
    settings["source.random"] = moved
    for part in ("objective", "optimizer"):
        settings[part] = f"'@{SCENES}/{tracker}.yaml'"
    settings["search"] = f"'@{SCENES}/demo.yaml'"
    scene = {"object": "hand_and_box.yaml", "two_hands": "two_hands.yaml"}.get(kind, "datasets/sh.yaml")
    return SCENES / scene, [f"{key}={flow(value)}" for key, value in settings.items()]


def video(media):
    """Returns the scene of the real video and its overrides."""
    poses = pathlib.Path(__file__).resolve().with_name("two_webcams_poses.csv")
    return SCENES / "two_webcams.yaml", ["evaluate.backend=cpu", "evaluate.threads=1",
                                          f"source.left={media / 'cam0_test.mp4'}",
                                          f"source.right={media / 'cam1_test.mp4'}",
                                          f"source.truth_states={poses}"]


def collect(program, table, scene, overrides, frames, seed):
    """Writes a table; returns a line about it."""
    if table.exists():
        return f"{table.name} is there already"
    unfinished = table.with_suffix(".part")
    command = [program, scene, unfinished, str(frames), str(seed), *overrides]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return f"{table.name}: {done.stderr.strip()}"
    unfinished.rename(table)
    return f"{table.name}: {sum(1 for _ in open(table)) - 1} rows"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("tables", type=pathlib.Path)
    arguments.add_argument("--jobs", type=int, default=2)
    arguments.add_argument("--frames", type=int, default=150, help="of each sequence, with the models in view")
    arguments.add_argument("--video", type=pathlib.Path, help="folder of cam0_test.mp4 and cam1_test.mp4")
    given = arguments.parse_args()
    given.tables.mkdir(parents=True, exist_ok=True)
    wanted = [(given.tables / f"{number:02}.csv", *sequence(number, given.frames), 2 * given.frames, number + 1)
              for number in range(SEQUENCES)]
    if given.video:
        wanted.append((given.tables / "video.csv", *video(given.video.resolve()), 140, 1))
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        running = [pool.submit(collect, given.program, *one) for one in wanted]
        for one in concurrent.futures.as_completed(running):
            print(one.result(), file=sys.stderr)


if __name__ == "__main__":
    main()
