"""A coloured box before two cameras, for tests: its mesh, its scene and pictures of it."""

import numpy as np

import hypotrack

VERTICES = np.array([[30 if i & 1 else -30, 45 if i & 2 else -45, 20 if i & 4 else -20]
                     for i in range(8)], float)
TRIANGLES = np.array([[0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1],
                      [2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7],
                      [3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5]]).T
COLORS = np.array([[250 if i & 1 else 20, 240 if i & 2 else 30, 230 if i & 4 else 40]
                   for i in range(8)], np.uint8)
MESHES = {"box": (VERTICES, TRIANGLES, COLORS)}
SIZE = (320, 240)


def scene(**more):
    """A scene of the box; its source is a synthetic one unless `more` says otherwise."""
    return {
        "models": [{"name": "box", "type": "rigid_mesh", "mesh": "attached:box", "units": "mm"}],
        "objective": {"type": "stereo_color"},
        "optimizer": {"type": "pso", "particles": 16, "generations": 8},
        "tile": {"size": 64},
        "init": {"pose": pose(0)},
        **more,
    }


def synthetic(frames=3):
    return {"type": "synthetic", "frames": frames,
            "cameras": {"width": SIZE[0], "height": SIZE[1], "focal_px": 300, "baseline_mm": 100},
            "keyframes": [{"frame": 0, "pose": pose(0)}, {"frame": 9, "pose": pose(9)}]}


def pose(i):
    return {"box": {"position_mm": [2 * i, 0, 400], "rotation_deg": [20, 30 + i, 0]}}


def session(scene_dict=None, **options):
    return hypotrack.Session(scene_dict or scene(), meshes=MESHES, **options)


def cameras():
    matrix = np.array([[300, 0, SIZE[0] / 2], [0, 300, SIZE[1] / 2], [0, 0, 1]])
    right = np.eye(4)
    right[0, 3] = -0.1
    return [hypotrack.Camera(matrix, SIZE), hypotrack.Camera(matrix, SIZE, camera_from_world=right)]


class Rig:
    """Renders pictures of the box in pose(i)."""

    def __init__(self):
        self.scene = session().scene
        self.cameras = cameras()
        self.renderer = hypotrack.Renderer(self.scene)
        noise = np.random.default_rng(1).integers(0, 255, (*SIZE[::-1], 3), np.uint8)
        self.background = noise // 4 + 96

    def state(self, i):
        return self.scene.pose(pose(i))

    def pictures(self, i):
        return [np.array(self.renderer.render(self.state(i), c, background=self.background)[0])
                for c in self.cameras]
