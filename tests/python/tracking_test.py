import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

import box
import hypotrack


def error(solution, rig, i):
    truth = rig.scene.landmarks(rig.state(i))
    return np.linalg.norm(solution.landmarks - truth, axis=1).mean()


class Tracking(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = box.Rig()

    def setUp(self):
        self.tracker = box.session().tracker(self.rig.cameras)

    def test_follows_the_box_through_pictures(self):
        for i in range(3):
            solution = self.tracker.track(*self.rig.pictures(i), time=i / 30)
            self.assertEqual(solution.status, hypotrack.Status.tracked)
            self.assertEqual(solution.statuses, {"box": hypotrack.Status.tracked})
            self.assertLess(error(solution, self.rig, i), 0.01)
        self.assertEqual(solution.frame, 2)
        self.assertGreater(solution.probabilities["box"], 0.5)
        self.assertEqual(solution.state.shape, (7,))
        self.assertIsNone(solution.sigmas)
        self.assertIn("cpu", self.tracker.backend)

    def test_gives_landmarks_by_name(self):
        solution = self.tracker.track(*self.rig.pictures(0), 0.0)
        self.assertEqual(solution.landmark_names, ["box.center", "box.end_y", "box.end_x"])
        np.testing.assert_array_equal(solution["box.end_y"], solution.landmarks[1])
        self.assertEqual(list(solution.by_landmark), solution.landmark_names)
        with self.assertRaisesRegex(KeyError, "did you mean 'box.center'"):
            solution["box.centre"]
        np.testing.assert_allclose(solution.landmarks, self.tracker.scene.landmarks(solution.state))
        self.assertEqual(json.loads(solution.json())["frame"], 0)

    def test_takes_views_and_missing_frames(self):
        views = [hypotrack.View(color=p) for p in self.rig.pictures(0)]
        self.assertEqual(self.tracker.track(views, 0.0).status, hypotrack.Status.tracked)
        self.assertEqual(self.tracker.track([], 0.1).status, hypotrack.Status.missing)
        self.assertEqual(self.tracker.track(None, 0.2).status, hypotrack.Status.missing)
        self.assertEqual(self.tracker.track(self.rig.pictures(3), 0.3).frame, 3)

    def test_takes_the_frames_of_a_source(self):
        session = box.session(box.scene(source=box.synthetic(), init={"from": "truth"}))
        source = session.source()
        self.assertEqual((source.frame_rate, source.frame_count), (30, 3))
        tracker = session.tracker(source.cameras)
        solutions = [tracker.track(frame) for frame in source]
        self.assertEqual([s.frame for s in solutions], [0, 1, 2])
        states = []
        session.run(on_frame=lambda f, s, e: states.append(s.state))
        np.testing.assert_array_equal([s.state for s in solutions], states)

    def test_sigmas_are_there_if_they_are_wanted(self):
        session = box.session(set={"tracker.uncertainty.enabled": True, "budget.evaluations": 4000})
        solution = session.tracker(self.rig.cameras).track(*self.rig.pictures(0), 0.0)
        self.assertEqual(solution.sigmas.shape, (3,))

    def test_refuses_frames_that_do_not_fit(self):
        left, right = self.rig.pictures(0)
        self.tracker.track(left, right, 0.5)
        for arguments, message in [
            ((left, right, 0.5), "expected a later time"),
            (([left], 0.6), "has 1 view; expected 2"),
            ((left, right[:100], 0.6), "100"),
            ((left, np.zeros((0, 0, 3), np.uint8), 0.6), "right: expected a numpy array"),
        ]:
            with self.assertRaisesRegex(hypotrack.DataError, message):
                self.tracker.track(*arguments)
        with self.assertRaisesRegex(hypotrack.DataError, "expected a larger index"):
            self.tracker.track(left, right, 0.6, index=0)
        self.assertEqual(self.tracker.track(left, right, 0.6).status, hypotrack.Status.tracked)

    def test_refuses_a_frame_after_the_largest_index(self):
        tracker = box.session().tracker(self.rig.cameras)
        tracker.track(None, 0.0, index=2**31 - 1)
        with self.assertRaisesRegex(hypotrack.DataError, "frame 2147483647 comes after"):
            tracker.track(None, 0.1)

    def test_outlives_its_session_and_its_pictures(self):
        solution = None
        for i in range(3):
            solution = self.tracker.track(*self.rig.pictures(i), time=i / 30)
        scene, landmarks = self.tracker.scene, solution.landmarks
        del self.tracker, solution
        self.assertEqual(scene.dimension, 7)
        self.assertEqual(landmarks.shape, (3, 3))


class Running(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = Path(self.folder.name) / "out"
        self.session = box.session(box.scene(source=box.synthetic()))

    def test_calls_back_for_every_frame_and_writes_results(self):
        seen, said = [], []
        complete = self.session.run(
            self.out, on_frame=lambda f, s, e: seen.append((f.index, s.status, e, f.views[1].color)),
            say=said.append)
        self.assertTrue(complete)
        self.assertEqual([s[0] for s in seen], [0, 1, 2])
        self.assertLess(max(s[2] for s in seen), 0.02)
        self.assertEqual(seen[0][3].shape, (240, 320, 3))
        self.assertFalse(seen[0][3].flags.writeable)
        self.assertTrue(any("tracking with" in line for line in said))
        self.assertTrue((self.out / "track.csv").exists())
        metrics = hypotrack.evaluate(self.out)
        self.assertEqual(metrics["frames"], 3)
        self.assertAlmostEqual(metrics["mean_error_mm"], 1000 * np.mean([s[2] for s in seen]), 3)

    def test_ends_where_a_callback_says_so(self):
        seen = []

        def on_frame(frame, solution, error):
            seen.append(frame.index)
            return len(seen) < 2

        self.assertFalse(self.session.run(on_frame=on_frame))
        self.assertEqual(seen, [0, 1])
        self.assertTrue(self.session.run(frames=1), "a session runs more than once")

    def test_ends_at_the_false_of_numpy_but_not_at_zero(self):
        for answer, complete in [(np.False_, False), (np.True_, True), (0, True)]:
            self.assertEqual(self.session.run(on_frame=lambda *_: answer), complete)

    def test_what_a_callback_raises_comes_out_of_the_run(self):
        def on_frame(frame, solution, error):
            raise LookupError("not today")

        with self.assertRaisesRegex(LookupError, "not today"):
            self.session.run(self.out, on_frame=on_frame)
        with self.assertRaises(LookupError):
            self.session.run(say=lambda text: {}["none"])

    def test_a_session_at_work_refuses_its_own_callbacks(self):
        def on_frame(frame, solution, error):
            self.session.run()

        with self.assertRaisesRegex(hypotrack.Error, "at work already"):
            self.session.run(on_frame=on_frame)

    def test_without_a_source_there_is_no_run(self):
        with self.assertRaisesRegex(hypotrack.ConfigError, "source: required key is missing"):
            box.session().run()


if __name__ == "__main__":
    unittest.main()
