import unittest

import numpy as np

import box
import hypotrack


class Costs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = box.Rig()
        cls.truth = cls.rig.state(0)
        cls.states = cls.truth + np.random.default_rng(1).normal(0, 0.005, (50, 7))
        cls.states[0] = cls.truth

    def setUp(self):
        self.cost = box.session().frame_cost(self.rig.cameras)
        self.cost.look(self.rig.pictures(0), self.truth)

    def test_are_least_at_the_truth(self):
        costs = self.cost(self.states)
        self.assertEqual(costs.shape, (50,))
        self.assertEqual(np.argmin(costs), 0)
        self.assertEqual(self.cost(self.truth), costs[0])
        np.testing.assert_array_equal(self.cost.terms(self.states)["stereo_color"], costs)

    def test_do_not_depend_on_strides_and_types_of_states(self):
        costs = self.cost(self.states)
        np.testing.assert_array_equal(self.cost(np.asfortranarray(self.states)), costs)
        np.testing.assert_array_equal(self.cost(np.repeat(self.states, 2, 0)[::2]), costs)
        np.testing.assert_array_equal(self.cost(list(self.states)), costs)
        singles = self.states.astype(np.float32)
        np.testing.assert_array_equal(self.cost(singles), self.cost(singles.astype(float)))

    def test_have_residuals_and_jacobians(self):
        self.assertTrue(self.cost.least_squares)
        residuals = self.cost.residuals(self.states[:3])
        self.assertEqual(residuals.shape[0], 3)
        np.testing.assert_array_equal(self.cost.residuals(self.states[1]), residuals[1])
        steps = np.r_[np.full(3, 0.002), np.zeros(4)]
        jacobian = self.cost.jacobian(self.states[1], steps)
        self.assertEqual(jacobian.shape, (residuals.shape[1], 7))
        self.assertFalse(jacobian[:, 3:].any())
        ends = self.cost.residuals(self.states[1] + np.outer([1, -1], [0.002] + 6 * [0]))
        np.testing.assert_allclose(jacobian[:, 0], (ends[0] - ends[1]) / 0.004, rtol=1e-4, atol=1e-2)
        self.assertTrue(self.cost.can_linearize)
        a, g = self.cost.normal_equations(self.states[1], np.full(7, 0.002))
        self.assertEqual((a.shape, g.shape), ((7, 7), (7,)))
        np.testing.assert_allclose(a, a.T)

    def test_refuse_states_that_are_none(self):
        bad = self.states.copy()
        bad[3, 2] = np.nan
        for states, message in [
            (bad, "state 3 has a number that is not finite"),
            (self.states[:, :6], r"shape \(N, 7\) or \(7,\); found \(50, 6\)"),
            (self.states[None], "found"),
            (np.zeros((0, 7)), "one at least"),
        ]:
            with self.assertRaisesRegex(hypotrack.Error, message):
                self.cost(states)
        with self.assertRaisesRegex(hypotrack.Error, r"^steps: .* shape \(7,\); found \(3,\)"):
            self.cost.jacobian(self.truth, np.ones(3))
        with self.assertRaisesRegex(hypotrack.Error, r"^state: .* shape \(7,\); found \(2, 7\)"):
            self.cost.jacobian(self.states[:2], np.ones(7))
        with self.assertRaisesRegex(hypotrack.Error, r"^around: .* shape \(7,\); found \(6,\)"):
            self.cost.look(self.rig.pictures(0), self.truth[:6])
        for blur in [np.nan, np.inf, -1]:
            with self.assertRaisesRegex(hypotrack.Error, "blur: expected pixels"):
                self.cost.normal_equations(self.truth, np.full(7, 0.002), blur)
        for states in ["states", [[1, 2], [3]]]:
            with self.assertRaisesRegex(hypotrack.Error, "^states: .*, of which numpy says: "):
                self.cost(states)

    def test_need_a_frame(self):
        cost = box.session().frame_cost(self.rig.cameras)
        with self.assertRaisesRegex(hypotrack.Error, "call look"):
            cost(self.truth)
        with self.assertRaisesRegex(hypotrack.DataError, "no views"):
            cost.look([], self.truth)
        with self.assertRaisesRegex(hypotrack.DataError, "100"):
            cost.look([p[:100] for p in self.rig.pictures(0)], self.truth)
        with self.assertRaises(hypotrack.Error):
            cost.look(self.rig.pictures(0), np.full(7, np.nan))

    def test_keep_the_pictures_that_they_look_at(self):
        costs = self.cost(self.states)
        junk = [self.rig.pictures(9) for _ in range(4)]
        np.testing.assert_array_equal(self.cost(self.states), costs)
        del junk


if __name__ == "__main__":
    unittest.main()
