import tempfile
import unittest
from pathlib import Path

import numpy as np

import box
import hypotrack


@hypotrack.plugin("optimizer", "py_sampler")
class Sampler:
    """Samples ever closer to the best point."""

    default_evaluations = 201

    def __init__(self, batch: int = 20, shrink=0.8):
        self.batch, self.shrink = batch, shrink

    def minimize(self, cost, region, budget, seed):
        random = np.random.default_rng(seed)
        spread = 0.5 * region.spread
        while cost.evaluations_left >= self.batch:
            cost(cost.best_point + random.normal(0, 1, (self.batch, cost.dimension)) * spread)
            spread = spread * self.shrink


@hypotrack.plugin("objective", "py_silhouette")
class Silhouette:
    """Share of pixels where the drawn silhouette and the mask disagree."""

    reads = ("mask",)

    def prepare(self, observation):
        self.masks = [v.mask > 0 for v in observation.views]
        self.observation = observation

    def costs(self, hypotheses):
        parts = [((inverse > 0) != mask).mean(axis=(1, 2))
                 for inverse, mask in zip(hypotheses.inverse_depths, self.masks)]
        return np.mean(parts, axis=0)


@hypotrack.plugin("source", "py_source")
class Rendered:
    """Pictures of the box that the program renders."""

    frame_rate = 10

    def __init__(self, frames: int, with_mask: bool = False):
        self.count, self.with_mask = frames, with_mask
        self.rig = box.Rig()
        self.cameras = self.rig.cameras

    def __iter__(self):
        for i in range(self.count):
            views = []
            for camera in self.cameras:
                color, depth, label = self.rig.renderer.render(
                    self.rig.state(i), camera, background=self.rig.background)
                views.append(hypotrack.View(color, mask=label if self.with_mask else None))
            yield hypotrack.Frame(views, i / 10, true_state=self.rig.state(i))


@hypotrack.plugin("output", "py_output")
class Lines:
    file_names = ["lines.txt"]

    def begin(self, files):
        self.file = files["lines.txt"].open("w")

    def frame(self, frame, solution):
        self.file.write(f"{frame.index} {solution.status.name}\n")

    def finish(self, complete):
        self.file.write(f"complete {complete}\n")
        self.file.close()


def registered(kind, **members):
    """Registers a class with these members under the name py_test."""
    hypotrack.register(kind, "py_test", type("Test", (), members))


class Plugins(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = box.Rig()

    def track(self, scene, frames=2):
        tracker = box.session(scene).tracker(self.rig.cameras)
        return [tracker.track(*self.rig.pictures(i), i / 30) for i in range(frames)]

    def error(self, scene, kind=hypotrack.PluginError):
        with self.assertRaises(kind) as caught:
            self.track(scene)
        return str(caught.exception)


class Optimizers(Plugins):
    def scene(self, **parameters):
        return box.scene(optimizer={"type": "py_sampler", **parameters})

    def test_finds_the_box_within_its_budget(self):
        for i, solution in enumerate(self.track(self.scene())):
            self.assertEqual(solution.status, hypotrack.Status.tracked)
            truth = self.rig.scene.landmarks(self.rig.state(i))
            self.assertLess(np.linalg.norm(solution.landmarks - truth, axis=1).mean(), 0.015)
        self.assertLessEqual(solution.evaluations, 201)

    def test_gets_its_parameters_strictly(self):
        self.assertIn("optimizer.batsh: unknown key; did you mean 'batch'?",
                      self.error(self.scene(batsh=3), hypotrack.ConfigError))
        self.assertIn("optimizer.batch: expected an integer",
                      self.error(self.scene(batch="x"), hypotrack.ConfigError))
        with tempfile.TemporaryDirectory() as folder:
            scene = self.scene(shrink=0.9)
            scene["source"] = box.synthetic(1)
            box.session(scene).run(folder)
            protocol = (Path(folder) / "run.yaml").read_text()
            self.assertIn("the optimizer 'py_sampler'", protocol.splitlines()[0])
            self.assertIn("batch: 20\n  shrink: 0.9", protocol)

    def test_an_exception_names_plugin_and_frame_and_has_its_traceback(self):
        def minimize(self, cost, region, budget, seed):
            raise ValueError("no way")

        registered("optimizer", minimize=minimize)
        message = self.error(box.scene(optimizer={"type": "py_test"}))
        for part in ["frame 0: ", "scene: optimizer: optimizer 'py_test'", "raised ValueError",
                     "Traceback (most recent call last)", "in minimize", 'ValueError: no way']:
            self.assertIn(part, message)

    def test_the_budget_ends_a_search_that_goes_on(self):
        calls = []

        def minimize(self, cost, region, budget, seed):
            calls.append((budget.evaluations, cost.evaluations_left))
            while True:
                cost(region.start)

        registered("optimizer", minimize=minimize)
        solutions = self.track(box.scene(optimizer={"type": "py_test"}, judge="none",
                                         budget={"evaluations": 30}))
        self.assertEqual(solutions[0].evaluations, 30)
        self.assertEqual(calls[0], (30, 29))

    def test_points_are_moved_into_the_bounds(self):
        seen = []

        def minimize(self, cost, region, budget, seed):
            far = np.clip(region.upper, -1e3, 1e3) + 1
            seen.append((cost(far), cost(np.minimum(far, region.upper)), cost.best_point))

        registered("optimizer", minimize=minimize)
        self.track(box.scene(optimizer={"type": "py_test"}), 1)
        self.assertEqual(seen[0][0], seen[0][1])

    def test_wrong_points_are_refused(self):
        messages = []

        def minimize(self, cost, region, budget, seed):
            for points in [np.zeros(3), np.zeros((2, 3)), np.full(cost.dimension, np.nan),
                           [[1], []]]:
                try:
                    cost(points)
                except hypotrack.Error as error:
                    messages.append(str(error))

        registered("optimizer", minimize=minimize)
        self.track(box.scene(optimizer={"type": "py_test"}, judge="none"), 1)
        self.assertEqual(len(messages), 4)
        self.assertIn("points: expected an array of shape (N, 7) or (7,); found (3,)", messages[0])
        self.assertIn("found list, of which numpy says: ", messages[3])
        self.assertIn("not finite", messages[2])

    def test_a_cost_that_is_kept_is_over_after_its_search(self):
        kept = []

        def minimize(self, cost, region, budget, seed):
            kept.append((cost, region.start))

        registered("optimizer", minimize=minimize)
        self.track(box.scene(optimizer={"type": "py_test"}), 1)
        with self.assertRaisesRegex(hypotrack.Error, "this search is over"):
            kept[0][0](kept[0][1])
        with self.assertRaisesRegex(hypotrack.Error, "this search is over"):
            kept[0][0].residuals(kept[0][1])
        self.assertEqual(kept[0][0].best_point.shape, (7,))

    def test_uses_residuals_and_derivatives(self):
        shapes = []

        def minimize(self, cost, region, budget, seed):
            for _ in range(3):
                a, g = cost.normal_equations(cost.best_point)
                cost(cost.best_point - np.linalg.solve(a + 1e-3 * np.diag(np.diag(a)), g))
            shapes.append((cost.residuals(region.start).ndim, cost.has_residuals))

        registered("optimizer", minimize=minimize, needs_jacobian=True)
        solutions = self.track(box.scene(optimizer={"type": "py_test"},
                                         search={"rotation_as": "tangent"}), 1)
        self.assertEqual(shapes[0], (1, True))
        self.assertEqual(solutions[0].status, hypotrack.Status.tracked)

    def test_tells_notes_under_its_name(self):
        def minimize(self, cost, region, budget, seed):
            self.log.warning(f"{self.scene.models[0]} looks odd")

        registered("optimizer", minimize=minimize)
        solution = self.track(box.scene(optimizer={"type": "py_test"}), 1)[0]
        self.assertTrue(any("optimizer (py_test)" in n and "box looks odd" in n
                            for n in solution.notes), solution.notes)

    def test_errors_of_the_cost_pass_through(self):
        def costs(self, hypotheses):
            raise ZeroDivisionError("in the objective")

        hypotrack.register("objective", "py_bad", type("Bad", (), {"costs": costs}))
        scene = self.scene()
        scene["objective"] = {"type": "py_bad"}
        message = self.error(scene)
        self.assertIn("objective 'py_bad'", message)
        self.assertNotIn("optimizer 'py_sampler'", message)


class Registering(unittest.TestCase):
    def refuse(self, kind, name, cls, message):
        with self.assertRaisesRegex(hypotrack.PluginError, message):
            hypotrack.register(kind, name, cls)

    def test_refuses_what_no_scene_could_use(self):
        self.refuse("optimiser", "x", Sampler, "expected optimizer, objective, starter, judge")
        self.refuse("optimizer", "Not-a-name", Sampler, "small letters")
        self.refuse("optimizer", "x", 3, "expected a class")

        class Untyped:
            def __init__(self, what):
                pass

        self.refuse("optimizer", "x", Untyped, "parameter 'what'")

    def test_refuses_parameters_that_no_scene_could_give(self):
        def mixed(self, x=[1, "a"]): pass
        def large(self, x=1 << 70): pass
        def taken(self, type="x"): pass
        def positional(self, x=1, /): pass
        for init, message in [(mixed, "default of the parameter 'x'"),
                              (large, "default of the parameter 'x'"),
                              (taken, "parameter 'type'.*own key"),
                              (positional, "parameter 'x'.*positional only")]:
            self.refuse("optimizer", "x", type("Test", (), {"__init__": init}), message)

    def test_takes_annotations_that_are_texts(self):
        def init(self, file: "Path", share: "float" = 1):
            self.values = (file, share)

        def minimize(self, cost, region, budget, seed):
            seen.append(self.values)

        seen = []
        registered("optimizer", __init__=init, minimize=minimize)
        rig = box.Rig()
        tracker = box.session(box.scene(optimizer={"type": "py_test", "file": "/x", "share": 2})
                              ).tracker(rig.cameras)
        tracker.track(*rig.pictures(0), 0.0)
        self.assertEqual(seen[0], (Path("/x"), 2.0))

    def test_what_a_constructor_raises_names_the_plugin(self):
        def raises(self):
            raise ValueError("no \udc80 luck")

        def interrupted(self):
            raise KeyboardInterrupt

        registered("optimizer", __init__=raises, minimize=None)
        with self.assertRaisesRegex(hypotrack.PluginError,
                                    r"(?s)scene: optimizer: optimizer 'py_test': .*no .udc80 luck"):
            box.session(box.scene(optimizer={"type": "py_test"}))
        registered("optimizer")
        with self.assertRaisesRegex(hypotrack.PluginError, "optimizer 'py_test': has no method"):
            box.session(box.scene(optimizer={"type": "py_test"}))
        registered("optimizer", __init__=interrupted, minimize=None)
        with self.assertRaises(KeyboardInterrupt):
            box.session(box.scene(optimizer={"type": "py_test"}))

    def test_says_which_method_is_missing(self):
        for kind, key, message in [("optimizer", "optimizer", "no method minimize"),
                                   ("objective", "objective", "no method costs"),
                                   ("source", "source", "attribute `cameras`"),
                                   ("output", "output", "no method frame")]:
            registered(kind)
            scene = box.scene(source=box.synthetic(1))
            scene[key] = {"also": {"type": "py_test"}} if key == "output" else {"type": "py_test"}
            with self.assertRaisesRegex(hypotrack.PluginError, message):
                box.session(scene).run(tempfile.mkdtemp() if key == "output" else None)


class Objectives(Plugins):
    def scene(self, **parameters):
        return box.scene(objective={"type": "py_silhouette", **parameters},
                         source={"type": "py_source", "frames": 2, "with_mask": True})

    def test_tracks_by_masks(self):
        errors = []
        box.session(self.scene()).run(on_frame=lambda f, s, e: errors.append(e))
        self.assertEqual(len(errors), 2)
        self.assertLess(max(errors), 0.03)

    def test_has_the_costs_of_its_arrays(self):
        session = box.session(self.scene())
        cost = session.frame_cost(self.rig.cameras)
        frame = next(iter(Rendered(1, True)))
        cost.look(frame, self.rig.state(0))
        states = self.rig.state(0) + np.outer(np.arange(150) * 0.001, [1] + 6 * [0])
        costs = cost(states)
        self.assertEqual(np.argmin(costs), 0)
        np.testing.assert_array_equal(cost(states[100]), costs[100])
        self.assertFalse(cost.least_squares)

    def test_joins_other_terms(self):
        scene = self.scene()
        scene["objective"] = [{"type": "stereo_color"}, {"type": "py_silhouette", "weight": 10}]
        cost = box.session(scene).frame_cost(self.rig.cameras)
        cost.look(next(iter(Rendered(1, True))), self.rig.state(0))
        states = np.tile(self.rig.state(3), (70, 1))
        terms = cost.terms(states)
        np.testing.assert_allclose(cost(states),
                                   terms["stereo_color"] + 10 * terms["py_silhouette"])

    def test_an_exception_names_plugin_and_frame(self):
        def prepare(self, observation):
            self.observation = observation

        def costs(self, hypotheses):
            if self.observation.frame == 1:
                raise RuntimeError("too dark")
            return np.zeros(len(hypotheses))

        registered("objective", prepare=prepare, costs=costs)
        message = self.error(box.scene(objective={"type": "py_test"}, judge="none"))
        for part in ["frame 1", "objective 'py_test'", "RuntimeError: too dark", "in costs"]:
            self.assertIn(part, message)

    def test_wrong_answers_are_refused(self):
        for answer, message in [(lambda n: np.zeros(n + 1), "shape"),
                                (lambda n: np.full(n, np.nan), "nan"),
                                (lambda n: np.full(n, -np.inf), "-inf"),
                                (lambda n: "none", "shape (8,); found str, of which numpy says"),
                                (lambda n: [[1, 2], [3]], "shape (8,); found list, of which"),
                                (lambda n: None, "shape (8,); found ()")]:
            registered("objective", costs=lambda self, h, answer=answer: answer(len(h)))
            error = self.error(box.scene(objective={"type": "py_test"}, judge="none",
                                         optimizer={"type": "pso", "particles": 8}))
            self.assertIn("objective 'py_test'", error)
            self.assertIn(message, error)

    def test_an_optimizer_that_needs_residuals_is_refused(self):
        registered("objective", costs=lambda self, h: np.zeros(len(h)))
        error = self.error(box.scene(objective={"type": "py_test"},
                                     optimizer={"type": "levenberg_marquardt"}),
                           hypotrack.ConfigError)
        for part in ["objective: the optimizer needs residuals", "py_test", "no residuals",
                     "optimizer: {type: pso}"]:
            self.assertIn(part, error)

    def test_what_it_reads_is_refused_if_there_is_no_such_picture(self):
        registered("objective", costs=lambda self, h: np.zeros(len(h)), reads=("colour",))
        self.assertIn("objective 'py_test': its `reads` has 'colour'; expected color, mask",
                      self.error(box.scene(objective={"type": "py_test"})))

    def test_may_need_no_rendering(self):
        registered("objective", needs_rendering=False,
                   costs=lambda self, h: (h.states[:, 0] - 0.01) ** 2 + len(h.inverse_depths))
        cost = box.session(box.scene(objective={"type": "py_test"})).frame_cost(self.rig.cameras)
        cost.look(self.rig.pictures(0), self.rig.state(0))
        self.assertAlmostEqual(cost(self.rig.state(0)), 0.0001)

    def test_what_it_keeps_stays_valid(self):
        kept = []

        def costs(self, hypotheses):
            kept.append((hypotheses, hypotheses.inverse_depths[0].sum(), self.observation,
                         self.observation.views[0].color.copy()))
            return hypotheses.states[:, 0]

        def prepare(self, observation):
            self.observation = observation

        registered("objective", prepare=prepare, costs=costs)
        self.track(box.scene(objective={"type": "py_test"}, judge="none"), 3)
        self.assertGreater(len({o.frame for _, _, o, _ in kept}), 1)
        for hypotheses, total, observation, color in kept[::7]:
            self.assertEqual(hypotheses.inverse_depths[0].sum(), total)
            np.testing.assert_array_equal(observation.views[0].color, color)
            self.assertEqual(observation.views[0].color.shape, (64, 64, 3))
            self.assertGreater(observation.views[1].valid.sum(), 0)
            self.assertAlmostEqual(observation.views[0].matrix[2, 2], 1)


class Judges(Plugins):
    def test_say_whether_a_pose_is_right(self):
        seen = []

        def log_odds(self, measures):
            seen.append((measures.values["correlation"], measures.model, len(measures.usual)))
            return self.answer

        for answer, status in [(5.0, "tracked"), (-5.0, "lost")]:
            registered("judge", log_odds=log_odds, answer=answer)
            solution = self.track(box.scene(judge="py_test"), 1)[0]
            self.assertEqual(solution.status.name, status)
            self.assertAlmostEqual(solution.probabilities["box"], 1 / (1 + np.exp(-answer)))
        self.assertEqual(seen[0][1:], (0, 18))

    def test_have_thresholds_and_parameters(self):
        class Fixed:
            def __init__(self, odds: float = 0.5):
                self.odds = odds

            def log_odds(self, measures):
                return self.odds

        hypotrack.register("judge", "py_test", Fixed)
        for judge, status in [({}, "tracked"), ({"tracked_above": 0.9, "certain_above": 0.9,
                                                 "first_above": 0.9, "confirmed_above": 0.9},
                                                "uncertain"), ({"odds": -9}, "lost")]:
            scene = box.scene(judge={"type": "py_test", **judge})
            self.assertEqual(self.track(scene, 1)[0].status.name, status, judge)

    def test_have_no_parameter_with_the_name_of_a_threshold(self):
        class Judge:
            def __init__(self, tracked_above: float = 0.5):
                pass

            def log_odds(self, measures):
                return 0

        with self.assertRaisesRegex(hypotrack.PluginError, "Judge: the parameter 'tracked_above'.*"
                                                           "threshold.*; name it otherwise"):
            hypotrack.register("judge", "py_test", Judge)

    def test_that_raise_or_have_no_answer_are_named(self):
        for answer, message in [(lambda: 1 / 0, "(?s)judge 'py_test'.*ZeroDivisionError"),
                                (lambda: float("nan"), "judge 'py_test'"),
                                (lambda: "likely", "judge 'py_test'")]:
            registered("judge", log_odds=lambda self, measures, answer=answer: answer())
            self.assertRegex(self.error(box.scene(judge="py_test")), message)


class Starters(Plugins):
    def track_from(self, **members):
        registered("starter", **members)
        return self.track(box.scene(init={"from": {"type": "py_test"}}), 1)[0]

    def test_give_a_state(self):
        truth = self.rig.state(0)
        frames = []

        def state(self, frame, cameras):
            frames.append((frame, len(cameras)))
            return truth

        self.assertEqual(self.track_from(state=state).status.name, "tracked")
        self.assertIsNone(frames[0][0])
        late = self.track_from(state=lambda self, frame, cameras: None if frame is None else truth)
        self.assertEqual(late.status.name, "tracked")

    def test_look_for_models(self):
        seen = []

        def find(self, frame, cameras, model):
            seen.append((frame.views[0].color.shape, [c.size for c in cameras], model))
            yield self.scene.pose(box.pose(0))[self.scene.slice(model)]

        self.assertEqual(self.track_from(find=find).status.name, "tracked")
        self.assertEqual(seen[0], ((240, 320, 3), [(320, 240)] * 2, "box"))

    def test_that_raise_or_propose_what_is_no_pose_are_named(self):
        for find, message in [(lambda *_: 1 / 0, "(?s)starter 'py_test'.*ZeroDivisionError"),
                              (lambda *_: [np.zeros(3)], "starter 'py_test'"),
                              (lambda *_: 3, "starter 'py_test'")]:
            registered("starter", find=find)
            self.assertRegex(self.error(box.scene(init={"from": {"type": "py_test"}}),
                                        hypotrack.Error), message)


class SourcesAndOutputs(Plugins):
    def test_a_run_of_python_from_end_to_end(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = box.scene(source={"type": "py_source", "frames": 3},
                              optimizer={"type": "py_sampler"},
                              output={"also": {"type": "py_output"}})
            frames = []
            self.assertTrue(box.session(scene).run(
                folder, on_frame=lambda f, s, e: frames.append((f.index, f.time, e))))
            self.assertEqual([f[:2] for f in frames], [(0, 0), (1, 0.1), (2, 0.2)])
            self.assertLess(max(f[2] for f in frames), 0.015)
            self.assertEqual((Path(folder) / "lines.txt").read_text(),
                             "0 tracked\n1 tracked\n2 tracked\ncomplete True\n")

    def test_pictures_alone_are_frames(self):
        rig = self.rig
        registered("source", cameras=rig.cameras,
                   __iter__=lambda self: iter([rig.pictures(0), [], tuple(rig.pictures(2))]))
        seen = []
        box.session(box.scene(source={"type": "py_test"})).run(
            on_frame=lambda f, s, e: seen.append((f.index, s.status.name)))
        self.assertEqual(seen, [(0, "tracked"), (1, "missing"), (2, "tracked")])

    def test_exceptions_name_plugin_and_end_the_run(self):
        def broken(self):
            yield self.pictures
            raise OSError("the camera is gone")

        registered("source", cameras=self.rig.cameras, pictures=self.rig.pictures(0),
                   __iter__=broken)
        with self.assertRaisesRegex(hypotrack.PluginError,
                                    "(?s)source 'py_test'.*OSError: the camera is gone"):
            box.session(box.scene(source={"type": "py_test"})).run()
        registered("source", cameras=self.rig.cameras,
                   __iter__=lambda self: iter([[np.zeros((10, 10, 3), np.uint8)] * 2]))
        with self.assertRaisesRegex(hypotrack.Error, "py_test"):
            box.session(box.scene(source={"type": "py_test"})).run()
        registered("output", frame=lambda self, frame, solution: {}["none"])
        with tempfile.TemporaryDirectory() as folder:
            scene = box.scene(source=box.synthetic(2), output={"also": {"type": "py_test"}})
            with self.assertRaisesRegex(hypotrack.Error, "(?s)output 'py_test'.*KeyError: 'none'"):
                box.session(scene).run(folder)


if __name__ == "__main__":
    unittest.main()
