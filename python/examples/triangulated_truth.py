"""Compares a tracker with landmarks that a detector of pictures finds, triangulated.

    triangulated_truth.py SCENE.yaml [FRAMES]

A source of its own wraps the frames and gives them `true_landmarks` from 2D landmarks in both
views, as MediaPipe or a person who clicks gives them. Here a renderer's truth, off by a pixel, is in
the place of the detector: replace detect().
"""

import itertools
import sys

import numpy as np

import hypotrack

PIXELS = 1.0  # standard deviation of the detector
random = np.random.default_rng(1)


def detect(view, camera, landmarks):
    """Returns the pixels (L, 2) of the landmarks in a view, NaN where one is not seen."""
    pixels = camera.project(landmarks)
    return pixels + random.normal(0, PIXELS, pixels.shape)


def triangulate(cameras, pixels):
    """Returns the points (L, 3) that cameras without distortion see at `pixels`, (L, 2) in each."""
    points = np.full((len(pixels[0]), 3), np.nan)
    projections = [c.matrix @ c.camera_from_world[:3] for c in cameras]
    for i, seen in enumerate(zip(*pixels)):
        if not np.isfinite(seen).all():
            continue
        rows = [axis * p[2] - p[k] for p, uv in zip(projections, seen) for k, axis in enumerate(uv)]
        homogeneous = np.linalg.svd(np.array(rows))[2][-1]
        points[i] = homogeneous[:3] / homogeneous[3]
    return points


def main(scene, count=5):
    session = hypotrack.Session(scene)
    recording = session.source()
    cameras, frames = recording.cameras, list(itertools.islice(recording, count))

    @hypotrack.plugin("source", "triangulated")
    class Triangulated:
        def __init__(self):
            self.cameras = cameras

        def __iter__(self):
            for frame in frames:
                truth = session.scene.landmarks(frame.true_state)
                pixels = [detect(v, c, truth) for v, c in zip(frame.views, cameras)]
                yield hypotrack.Frame(frame.views, frame.time, frame.index,
                                      true_state=frame.true_state,
                                      true_landmarks=triangulate(cameras, pixels))

    errors = []
    hypotrack.Session(scene, set={"source": {"type": "triangulated"}}).run(
        on_frame=lambda frame, solution, error: errors.append(1000 * error))
    print("error against triangulated landmarks, mm:", np.round(errors, 1))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5)
