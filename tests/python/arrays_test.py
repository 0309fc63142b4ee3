import gc
import sys
import unittest

import numpy as np

import box
import hypotrack


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = box.Rig()

    def view(self, picture, **more):
        return hypotrack.View(color=picture, **more)

    def test_share_memory_with_the_array_and_keep_it(self):
        picture = np.zeros((240, 320, 3), np.uint8)
        view = self.view(picture)
        picture[5, 6] = [1, 2, 3]
        np.testing.assert_array_equal(view.color[5, 6], [1, 2, 3])
        self.assertTrue(np.shares_memory(view.color, picture))
        before = sys.getrefcount(picture)
        del view
        self.assertEqual(sys.getrefcount(picture), before - 1)

    def test_outlive_what_they_were_made_of(self):
        color = self.view(np.full((240, 320, 3), 7, np.uint8)).color
        gc.collect()
        junk = [np.zeros((240, 320, 3), np.uint8) for _ in range(20)]
        self.assertEqual(color.min(), 7)
        del junk

    def test_a_tracker_lets_go_of_old_ones(self):
        tracker = box.session().tracker(self.rig.cameras)
        first = self.rig.pictures(0)
        free = sys.getrefcount(first[0])
        tracker.track(*first, 0.0)
        for i in range(1, 4):
            tracker.track(*self.rig.pictures(i), i / 30)
        self.assertEqual(sys.getrefcount(first[0]), free)

    def test_may_be_parts_of_larger_ones(self):
        left, right = self.rig.pictures(0)
        both = np.concatenate([left, right], axis=1)
        tracker = box.session().tracker(self.rig.cameras)
        whole = box.session().tracker(self.rig.cameras)
        of_parts = tracker.track(both[:, :320], both[:, 320:], 0.0)
        np.testing.assert_array_equal(of_parts.state, whole.track(left, right, 0.0).state)

    def test_of_other_types_shapes_and_strides_are_refused(self):
        good = np.zeros((240, 320, 3), np.uint8)
        for bad, message in [
            (good.astype(float), "found float64 of shape .240, 320, 3."),
            (good.astype(np.int8), "found int8"),
            (good[:, :, 0], "found uint8 of shape .240, 320."),
            (np.zeros((240, 320, 4), np.uint8), "found uint8 of shape .240, 320, 4."),
            (good[::-1], "ascontiguousarray"),
            (good[:, ::2], "ascontiguousarray"),
            (good[:, :, ::-1], "ascontiguousarray"),
            (good.transpose(1, 0, 2), "ascontiguousarray"),
            (np.broadcast_to(good[0], (240, 320, 3)), "ascontiguousarray"),
            ([[1, 2]], "found list"),
            ("left.png", "found str"),
        ]:
            with self.assertRaisesRegex(hypotrack.DataError, message):
                self.view(bad)
        with self.assertRaisesRegex(hypotrack.DataError, "a view needs a picture"):
            hypotrack.View()

    def test_depth_and_masks_have_types_of_their_own(self):
        depth, mask = np.ones((4, 5), np.float32), np.ones((4, 5), bool)
        view = hypotrack.View(depth=depth, mask=mask)
        self.assertIsNone(view.color)
        self.assertEqual(view.depth[0, 0], 1)
        self.assertEqual(view.mask.dtype, np.uint8)
        for bad in [depth.astype(float), depth.astype(">f4"), depth[:, :, None], depth.T]:
            with self.assertRaises(hypotrack.DataError):
                hypotrack.View(depth=bad)
        raw = np.zeros(4 * 20 + 1, np.uint8)[1:].view(np.uint8)
        unaligned = np.frombuffer(raw.data, np.float32, 20).reshape(4, 5)
        with self.assertRaisesRegex(hypotrack.DataError, "contiguous"):
            hypotrack.View(depth=unaligned)

    def test_that_are_read_only_are_taken(self):
        picture = np.zeros((240, 320, 3), np.uint8)
        picture.flags.writeable = False
        self.assertEqual(self.view(picture).color.shape, (240, 320, 3))

    def test_that_are_rendered_have_colour_depth_and_label(self):
        camera = self.rig.cameras[0]
        color, depth, label = self.rig.renderer.render(self.rig.state(0), camera)
        self.assertEqual((color.shape, depth.shape, label.shape),
                         ((240, 320, 3), (240, 320), (240, 320)))
        self.assertTrue(((depth > 0) == (label == 1)).all())
        before = color.copy()
        self.rig.renderer.render(self.rig.state(9), camera)
        np.testing.assert_array_equal(color, before, "what was drawn before stays")
        self.assertAlmostEqual(np.median(depth[depth > 0]), 0.38, 1)
        row, column = np.argwhere(depth > 0).mean(axis=0)
        self.assertLess(np.hypot(*(camera.project([0, 0, 0.4]) - [column, row])), 5)
        with self.assertRaisesRegex(hypotrack.DataError, "camera's size"):
            self.rig.renderer.render(self.rig.state(0), camera,
                                     background=np.zeros((10, 10, 3), np.uint8))
        with self.assertRaises(TypeError):
            hypotrack.Renderer(None)
        with self.assertRaisesRegex(hypotrack.Error, r"^state: .* shape \(7,\); found \(6,\)"):
            self.rig.renderer.render(np.zeros(6), camera)
        with self.assertRaisesRegex(hypotrack.Error, "^state: number 0 is nan; expected finite"):
            self.rig.renderer.render(np.full(7, np.nan), camera)


class Shapes(unittest.TestCase):
    """Messages of wrong arrays name the argument, what was found and what was expected."""

    def refused(self, message, function, *arguments, **named):
        with self.assertRaisesRegex(hypotrack.Error, message):
            function(*arguments, **named)

    def test_of_cameras(self):
        camera = box.cameras()[0]
        self.refused(r"^matrix: .* shape \(3, 3\); found \(4, 4\)", hypotrack.Camera, np.eye(4))
        self.refused(r"^matrix: .* shape \(3, 3\); found list, of which numpy says: .*inhomogeneous",
                     hypotrack.Camera, [[1, 2], [3]])
        self.refused(r"^camera_from_world: .* shape \(4, 4\); found str, of which numpy says: .*'no'",
                     hypotrack.Camera, np.eye(3), camera_from_world="no")
        self.refused(r"^points: .* shape \(N, 3\) or \(3,\); found \(2, 4\)", camera.project,
                     np.zeros((2, 4)))
        self.refused(r"^points: .*; found dict", camera.project, {})

    def test_of_distortion(self):
        matrix = np.array([[300, 0, 160], [0, 300, 120], [0, 0, 1]])
        for shape in [(5,), (1, 5), (5, 1)]:  # calibrateCamera() of OpenCV gives those of two axes
            camera = hypotrack.Camera(matrix, (320, 240), np.full(shape, 0.01))
            self.assertEqual(camera.distortion, [0.01] * 5)
        self.refused(r"^distortion: .* shape \(K,\); found \(3, 3\)", hypotrack.Camera, matrix,
                     distortion=np.eye(3))

    def test_of_scenes_metrics_and_meshes(self):
        scene = box.session().scene
        self.refused(r"^state: .* shape \(7,\); found \(6,\)", scene.normalize, np.zeros(6))
        self.refused(r"^base: .* shape \(7,\); found \(2, 7\)", scene.pose, {}, np.zeros((2, 7)))
        self.refused(r"^states: .*; found list, of which numpy says", scene.landmarks, [[1, 2], [3]])
        points = np.zeros((2, 1, 3))
        self.refused(r"^truth: .* shape \(N, 1, 3\); found \(2, 1, 2\)", hypotrack.metrics, ["a.b"],
                     points, points[:, :, :2])
        self.refused(r"^times: .* shape \(2,\); found \(3,\)", hypotrack.metrics, ["a.b"], points,
                     points, [1, 2, 3])
        self.refused(r"^box: vertices: .* shape \(N, 3\); found \(8, 2\)", hypotrack.Session,
                     box.scene(), meshes={"box": (box.VERTICES[:, :2], box.TRIANGLES)})
        self.refused(r"^box: triangles: .*; found list", hypotrack.Session, box.scene(),
                     meshes={"box": (box.VERTICES, [[1, 2, 3], [4]])})


if __name__ == "__main__":
    unittest.main()
