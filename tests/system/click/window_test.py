#!/usr/bin/env python3
"""Clicks a box's corners in the window of `hypotrack click` and starts from what it saves.

usage: window_test.py HYPOTRACK
Exits with 77 (skipped), saying why, where there is no virtual display or nothing that clicks.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
for needed, package in (("Xvfb", "xvfb"), ("xvfb-run", "xvfb"), ("xdotool", "xdotool")):
    if not shutil.which(needed):
        print(f"skipped: {needed} is not installed (package {package})")
        sys.exit(SKIPPED)

SCENE = """models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
source:
  type: synthetic
  cameras: {width: 640, height: 480, focal_px: 640, baseline_mm: 80}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400], rotation_deg: [20, 30, 0]}}}
    - {frame: 1, pose: {box: {position_mm: [0, 0, 400], rotation_deg: [20, 30, 0]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 8, generations: 4}
tile: {size: 32}
init: {from: clicks, file: pose.clicks.yaml}
output: {overlay: false}
"""
# Where the corners 000, 001 and 010 are: pixels of the left view, then of the right one.
CORNERS = [((236, 198), (107, 198)), ((272, 181), (153, 181)), ((249, 287), (125, 287))]
WIDTH = 640


def xdotool(*words):
    return subprocess.run(("xdotool", *map(str, words)), capture_output=True, text=True, check=False).stdout


def wait_for(what, found):
    for _ in range(200):
        value = found()
        if value:
            return value
        time.sleep(0.1)
    sys.exit(f"waited 20 s for {what}")


def click_all(program, folder):
    """Runs the command on this display, clicks and saves."""
    with subprocess.Popen((program, "click", folder / "scene.yaml", "--out", folder / "pose.yaml")) as process:
        try:
            window = wait_for("the window", lambda: xdotool("search", "--name", "^hypotrack click$").split())[-1]
            time.sleep(1)
            xdotool("windowfocus", window)
            for i, corner in enumerate(CORNERS):
                for view, (x, y) in enumerate(corner):
                    xdotool("mousemove", "--window", window, x + view * WIDTH, y, "click", 1)
                    time.sleep(0.3)
                xdotool("key", "n" if i + 1 < len(CORNERS) else "s")
                time.sleep(0.3)
            wait_for("the end", lambda: process.poll() is not None)
        finally:
            process.kill()
    return process.returncode


def main():
    program = pathlib.Path(sys.argv[1])
    if len(sys.argv) > 2:  # on the virtual display
        sys.exit(click_all(program, pathlib.Path(sys.argv[2])))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.yaml").write_text(SCENE)
        environment = {k: v for k, v in os.environ.items() if k not in ("WAYLAND_DISPLAY", "QT_QPA_PLATFORM")}
        # A server without clients for a moment would start anew, and refuse those that come then.
        subprocess.run(("xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset", sys.executable, __file__, program,
                        folder), env=environment, check=True)
        pose = (folder / "pose.yaml").read_text()
        print(pose)
        x, y, z = (float(v) for v in pose.split("position_mm: [")[1].split("]")[0].split(","))
        assert abs(x) < 5 and abs(y) < 5 and abs(z - 400) < 12, pose
        checked = subprocess.run((program, "validate", folder / "scene.yaml"), capture_output=True, text=True,
                                 check=True)
        assert "3 clicks" in checked.stderr, checked.stderr
        init = f"init={{from: file, file: {folder / 'pose.yaml'}}}"
        subprocess.run((program, "validate", folder / "scene.yaml", "--set", init), check=True)


main()
