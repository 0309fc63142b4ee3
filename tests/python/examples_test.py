import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import hypotrack

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "configs/scenes/demo.yaml"


def run(name, *arguments):
    done = subprocess.run([sys.executable, ROOT / "python/examples" / name, *map(str, arguments)],
                          capture_output=True, text=True, timeout=280, env=os.environ)
    if done.returncode and "No module named" in done.stderr:
        raise unittest.SkipTest(done.stderr.splitlines()[-1])
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Examples(unittest.TestCase):
    def test_an_optimizer_of_scipy_tracks_the_demo(self):
        text = run("scipy_optimizer.py", DEMO, 3)
        frames = re.findall(r"frame (\d): (\w+), ([\d.]+) mm off, (\d+) evaluations", text)
        self.assertEqual(len(frames), 3, text)
        self.assertLess(max(float(f[2]) for f in frames), 12, text)

    def test_convergence_is_plotted(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "convergence.svg"
            text = run("convergence.py", DEMO, picture, 2)
            self.assertEqual(len(re.findall(r": \d+ searches, ", text)), 3, text)
            self.assertIn("<svg", picture.read_text())

    def test_triangulated_landmarks_judge_a_tracker(self):
        text = run("triangulated_truth.py", DEMO, 3)
        errors = [float(n) for n in re.findall(r"\d+\.\d*", text)]
        self.assertEqual(len(errors), 3, text)
        self.assertLess(max(errors), 12, text)
        self.assertGreater(min(errors), 0.3, "a pixel off")


if __name__ == "__main__":
    unittest.main()
