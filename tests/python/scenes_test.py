import tempfile
import unittest
from pathlib import Path

import numpy as np

import box
import hypotrack


class Scenes(unittest.TestCase):
    def error(self, scene, kind=hypotrack.ConfigError, **options):
        with self.assertRaises(kind) as caught:
            box.session(scene, **options)
        return str(caught.exception)

    def test_exceptions_have_the_names_of_cpp(self):
        for name in ["ConfigError", "DataError", "PluginError", "DeviceError", "OutputError"]:
            self.assertTrue(issubclass(getattr(hypotrack, name), hypotrack.Error))
            self.assertEqual(getattr(hypotrack, name).__module__, "hypotrack")

    def test_mistakes_name_the_document_and_the_key_path(self):
        self.assertIn("mine: tile.size: expected an integer",
                      self.error(box.scene(tile={"size": "big"}), name="mine"))
        self.assertIn("scene: tile.siez: unknown key", self.error(box.scene(tile={"siez": 3})))
        self.assertIn("scene: optimizer.type: there is no optimizer 'psa'",
                      self.error(box.scene(optimizer={"type": "psa"}), hypotrack.PluginError))
        self.assertIn("--set tile.size=7: tile.size: 7 is out of range",
                      self.error(box.scene(), set={"tile.size": 7}))

    def test_takes_the_values_of_numpy_and_paths(self):
        scene = box.session(box.scene(tile={"size": np.int64(96), "padding": np.float32(0.25)},
                                      seed=np.uint8(3))).scene
        self.assertEqual(scene.models, ["box"])
        self.assertIn("tile.size: expected an integer",
                      self.error(box.scene(tile={"size": np.array([1.0, 2.0])})))

    def test_refuses_values_that_no_scene_has(self):
        self.assertIn("mine: tile.size: expected a dict, list",
                      self.error(box.scene(tile={"size": {1}}), name="mine"))
        self.assertIn("scene: seed: the integer has more than 64 bits",
                      self.error(box.scene(seed=1 << 70)))
        self.assertIn("scene: tile: the key 3 is no text", self.error(box.scene(tile={3: 4})))
        self.assertIn("scene: tile: the text '\\udc80' has no UTF-8",
                      self.error(box.scene(tile="\udc80")))
        with self.assertRaisesRegex(hypotrack.ConfigError, "path of a file, or a dict; found int"):
            hypotrack.Session(3)
        with self.assertRaisesRegex(hypotrack.ConfigError, "cannot be opened"):
            hypotrack.Session("none.yaml")
        loop = []
        loop.append(loop)
        self.assertIn("nested deeper", self.error(box.scene(tile=loop)))

    def test_names_files_whose_names_are_no_text(self):
        with self.assertRaises(hypotrack.ConfigError) as caught:
            hypotrack.Session("/tmp/\udc80.yaml")
        self.assertIn("\udc80.yaml", str(caught.exception))

    def test_refuses_options_that_are_none(self):
        for options, message in [({"set": "tile.size=64"}, "set: expected a list.*found str"),
                                 ({"set": 5}, "set: expected a list.*found int"),
                                 ({"set": [5]}, "set: expected text, found 5"),
                                 ({"set": {5: 1}}, "set: expected text, found 5"),
                                 ({"set": {"tile.size": {1}}}, "set: tile.size: expected a dict")]:
            self.assertRegex(self.error(box.scene(), **options), message)
        with self.assertRaisesRegex(hypotrack.ConfigError, "meshes: expected text, found 3"):
            hypotrack.Session(box.scene(), meshes={3: box.MESHES["box"]})
        with self.assertRaisesRegex(hypotrack.ConfigError, "frames: expected 1 or more"):
            box.session(box.scene(source=box.synthetic(1))).run(frames=0)

    def test_overrides_have_all_values_of_scenes(self):
        self.assertIn("tile.padding: .inf is out of range",
                      self.error(box.scene(), set={"tile.padding": np.inf}))
        self.assertIn("not-a-number", self.error(box.scene(), set={"tile.padding": np.nan}))
        self.assertIn("the text \"64\"", self.error(box.scene(), set={"tile.size": "64"}))
        scene = box.session(box.scene(), set={"models": [{**box.scene()["models"][0],
                                                          "name": "true"}],
                                              "init.pose": {}, "tile": {"size": 64}}).scene
        self.assertEqual(scene.models, ["true"])

    def test_takes_a_tracker_and_overrides(self):
        scene = {"models": box.scene()["models"], "tracker": "@trackers/rigid",
                 "init": {"pose": box.pose(0)}}
        cost = box.session(scene, set=["tile.size=64"]).frame_cost(box.cameras())
        self.assertEqual(cost.term_names, ["contour", "stereo_color"])
        self.assertEqual(box.session(scene, set={"models.0.name": "crate", "init.pose": None})
                         .scene.models, ["crate"])

    def test_a_run_of_a_dict_is_repeated_by_its_run_yaml(self):
        with tempfile.TemporaryDirectory() as folder:
            states = []
            keep = lambda frame, solution, error: states.append(solution.state)
            scene = box.scene(source=box.synthetic(2))
            box.session(scene).run(Path(folder) / "out", on_frame=keep)
            protocol = Path(folder) / "out" / "run.yaml"
            self.assertIn("holds the mesh attached:box", protocol.read_text().splitlines()[0])
            with self.assertRaisesRegex(hypotrack.ConfigError, "attached is none"):
                hypotrack.Session(protocol)
            hypotrack.Session(protocol, meshes=box.MESHES).run(on_frame=keep)
            np.testing.assert_array_equal(states[:2], states[2:])

    def test_refuses_meshes_that_are_none(self):
        vertices, triangles, colors = box.MESHES["box"]

        def error(*mesh):
            with self.assertRaises(hypotrack.Error) as caught:
                hypotrack.Session(box.scene(), meshes={"box": mesh})
            return str(caught.exception)

        self.assertIn("found 1 parts", error(vertices))
        self.assertIn("expected an array of shape (N, 3)", error(vertices[:, :2], triangles))
        self.assertIn("expected an array of integers", error(vertices, triangles.astype(float)))
        self.assertIn("expected an array of uint8", error(vertices, triangles, colors / 255))
        self.assertIn("attached:box", error(vertices, triangles + 1))
        self.assertIn("attached:box", error(vertices * np.nan, triangles))
        self.assertIn("7 colours for 8 vertices", error(vertices, triangles, colors[:7]))

    def test_a_scene_tells_its_state(self):
        scene = box.session().scene
        self.assertEqual(scene.dimension, 7)
        self.assertEqual(scene.parameters[0]["name"], "box.position_x")
        self.assertEqual(scene.slice("box"), slice(0, 7, 1))
        state = scene.pose(box.pose(0))
        np.testing.assert_allclose(state[:3], [0, 0, 0.4])
        np.testing.assert_allclose(scene.landmarks(np.stack([state, state]))[1],
                                   scene.landmarks(state))
        np.testing.assert_allclose(scene.normalize(np.r_[state[:3], 2 * state[3:]]), state)
        vertices, triangles = scene.mesh("box")
        self.assertEqual((vertices.shape, triangles.shape), ((8, 3), (12, 3)))
        with self.assertRaisesRegex(hypotrack.ConfigError, "no model 'cup'"):
            scene.slice("cup")
        with self.assertRaisesRegex(hypotrack.ConfigError, "pose"):
            scene.pose({"cup": {}})


class Calibrations(unittest.TestCase):
    def test_are_read_from_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "rig.yaml"
            file.write_text("cameras:\n" + "".join(
                f"  - {{image_width: 320, image_height: 240, model: none, "
                f"K: [300, 0, 160, 0, 300, 120, 0, 0, 1], R: [1, 0, 0, 0, 1, 0, 0, 0, 1], "
                f"T: [{x}, 0, 0]}}\n" for x in (0, -0.1)))
            cameras = hypotrack.load_calibration(file)
            self.assertEqual(len(cameras), 2)
            self.assertEqual(cameras[1].size, (320, 240))
        with self.assertRaises(hypotrack.DataError):
            hypotrack.load_calibration("/none.yaml")

    def test_may_leave_the_size_to_the_first_picture(self):
        rig = box.Rig()
        unsized = [hypotrack.Camera(c.matrix, camera_from_world=c.camera_from_world)
                   for c in rig.cameras]
        tracker = box.session().tracker(unsized)
        self.assertEqual(tracker.track(*rig.pictures(0), 0.0).status.name, "tracked")
        self.assertEqual(tracker.cameras[0].size, box.SIZE)
        with self.assertRaises(hypotrack.DataError):
            hypotrack.Camera([[300, 0, np.nan], [0, 300, 120], [0, 0, 1]])
        with self.assertRaisesRegex(hypotrack.ConfigError, "size: found 5"):
            hypotrack.load_calibration("rig.yaml", size=5)

    def test_are_made_of_matrices(self):
        left, right = box.cameras()
        np.testing.assert_array_equal(left.matrix[0], [300, 0, 160])
        self.assertEqual(right.camera_from_world[0, 3], -0.1)
        np.testing.assert_allclose(right.project([[0.1, 0, 1], [0.1, 0, -1]]),
                                   [[160, 120], [np.nan, np.nan]])
        for matrix, options, message in [
            (np.eye(2), {}, r"shape \(3, 3\)"),
            (np.array([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]), {}, "without skew"),
            (-np.eye(3), {}, "without skew|positive"),
            (np.eye(3), {"distortion": [1, 2, 3]}, "coefficients"),
            (np.eye(3), {"model": "fish"}, "expected none, brown or fisheye"),
            (np.eye(3), {"camera_from_world": 2 * np.eye(4)}, "last row"),
        ]:
            with self.assertRaisesRegex(hypotrack.Error, message):
                hypotrack.Camera(matrix, (10, 10), **options)


class Metrics(unittest.TestCase):
    def test_compare_landmarks(self):
        truth = np.zeros((4, 2, 3))
        estimate = truth + [0.003, 0, 0.004]
        estimate[3] = np.nan
        metrics = hypotrack.metrics(["a.x", "a.y"], estimate, truth, np.arange(4) / 30)
        self.assertAlmostEqual(metrics["mean_error_mm"], 5)
        self.assertEqual(metrics["evaluated_frames"], 3)
        np.testing.assert_allclose(metrics["errors"][:3], 0.005)
        self.assertTrue(np.isnan(metrics["errors"][3]))
        with self.assertRaisesRegex(hypotrack.Error, r"shape \(N, 2, 3\)"):
            hypotrack.metrics(["a.x", "a.y"], estimate[0], truth)


if __name__ == "__main__":
    unittest.main()
