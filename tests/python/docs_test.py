"""Runs the code of docs/howto/python.md."""

import re
import tempfile
import unittest
from pathlib import Path

import numpy as np

import hypotrack

ROOT = Path(__file__).resolve().parents[2]


class Guide(unittest.TestCase):
    def test_its_code_runs(self):
        text = (ROOT / "docs/howto/python.md").read_text()
        tracking, costs, objective = re.findall(r"```python\n(.*?)```", text, re.S)
        scene_file = ROOT / "configs/scenes/demo.yaml"
        source = hypotrack.Session(scene_file).source()
        frames = [next(source) for _ in range(3)]
        with tempfile.TemporaryDirectory() as folder:
            rig = Path(folder) / "rig.yaml"
            rig.write_text("cameras:\n" + "".join(
                "  - {{image_width: 1280, image_height: 720, model: none, K: {}, R: {}, T: {}}}\n"
                .format(c.matrix.ravel().tolist(), c.camera_from_world[:3, :3].ravel().tolist(),
                        c.camera_from_world[:3, 3].tolist()) for c in source.cameras))
            names = {"pictures": [[v.color for v in f.views] for f in frames], "frame": frames[0],
                     "source": source, "scene_file": scene_file, "steps": np.full(27, 0.001)}
            exec(tracking.replace("rig.yaml", str(rig)), names)
        self.assertEqual(names["solution"].frame, 2)
        self.assertIn("hand.index_tip", names["solution"].landmark_names)
        names["states"] = frames[0].true_state + np.random.default_rng(1).normal(0, 0.01, (9, 27))
        exec(costs, names)
        self.assertEqual(names["costs"].shape, (9,))
        self.assertEqual(names["jacobian"].shape, (names["residuals"].shape[1], 27))
        exec(objective, names)
        cost = names["other"].frame_cost(source.cameras)
        cost.look(frames[0], frames[0].true_state)
        terms = cost.terms(names["states"])
        self.assertEqual(list(terms), ["stereo_color", "brightness"])
        self.assertTrue((terms["brightness"] != 0).all())


if __name__ == "__main__":
    unittest.main()
