#!/usr/bin/env python3
"""Prints a scene in which a scene's motion repeats: soak_scene.py MINUTES SCENE.yaml."""
import re
import sys
from pathlib import Path

PERIOD = 150  # frames of the motion
FRAMES_PER_SECOND = 250  # that a run tracks at most
MOST = 1000  # repetitions; a scene file has a limit

minutes, scene = int(sys.argv[1]), Path(sys.argv[2]).resolve()
keyframes = re.findall(r"^    - \{frame: (\d+), (.*)\}$", scene.read_text(), re.MULTILINE)
times = min(MOST, max(1, -(-minutes * 60 * FRAMES_PER_SECOND // PERIOD)))
print(f'models: "@{scene}#models"\nsource:\n  type: synthetic')
for key in ("frame_rate", "cameras", "light", "sensor", "gestures"):
    print(f'  {key}: "@{scene}#source.{key}"')
print("  keyframes:")
for k in range(times):
    for frame, rest in keyframes:
        print(f"    - {{frame: {k * PERIOD + int(frame)}, {rest}}}")
print('tracker: "@trackers/recommended"\ninit: {from: truth}\noutput: {overlay: false, worst_frames: 0}')
