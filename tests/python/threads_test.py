"""Rules of the GIL: it is free while hypotrack works, and threads of hypotrack may call Python."""

import os
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import box
import hypotrack
import plugins_test  # noqa: F401: registers plugins


class Threads(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = box.Rig()
        cls.frames = [cls.rig.pictures(i) for i in range(4)]

    def states(self, scene):
        tracker = box.session(scene).tracker(self.rig.cameras)
        return [tracker.track(*f, i / 30).state for i, f in enumerate(self.frames)]

    def in_threads(self, count, function):
        results, errors = [None] * count, []

        def call(k):
            try:
                results[k] = function()
            except BaseException as error:
                errors.append(error)

        threads = [threading.Thread(target=call, args=(k,)) for k in range(count)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(120)
            self.assertFalse(thread.is_alive(), "the threads wait for each other")
        self.assertEqual(errors, [])
        return results

    def test_python_runs_while_a_frame_is_tracked(self):
        tracker = box.session(box.scene(budget={"evaluations": 200000}, optimizer={
            "type": "pso", "particles": 500, "generations": 400})).tracker(self.rig.cameras)
        ticks, done = [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        tracker.track(*self.frames[0], 0.0)
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 20)

    def test_trackers_of_several_threads_find_what_one_alone_finds(self):
        for scene in [box.scene(),
                      box.scene(optimizer={"type": "py_sampler"}),
                      box.scene(objective=[{"type": "stereo_color"}, {"type": "py_count"}],
                                optimizer={"type": "py_sampler"})]:
            alone = self.states(scene)
            for found in self.in_threads(4, lambda: self.states(scene)):
                np.testing.assert_array_equal(found, alone)

    def test_one_tracker_refuses_a_second_thread(self):
        inside, go_on = threading.Event(), threading.Event()

        def minimize(self, cost, region, budget, seed):
            inside.set()
            go_on.wait(60)

        plugins_test.registered("optimizer", minimize=minimize)
        tracker = box.session(box.scene(optimizer={"type": "py_test"})).tracker(self.rig.cameras)
        thread = threading.Thread(target=lambda: tracker.track(*self.frames[0], 0.0))
        thread.start()
        inside.wait(60)
        with self.assertRaisesRegex(hypotrack.Error, "this tracker is at work already"):
            tracker.track(*self.frames[1], 0.1)
        go_on.set()
        thread.join()

    def test_an_optimizer_may_use_threads_of_its_own(self):
        def minimize(self, cost, region, budget, seed):
            threads = [threading.Thread(target=attempt, args=(cost, region)) for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()

        refused = []

        def attempt(cost, region):
            for _ in range(20):
                try:
                    cost(np.tile(region.start, (5, 1)))
                except hypotrack.BudgetSpent:
                    return
                except hypotrack.Error as error:  # another thread is at it
                    refused.append(str(error))

        plugins_test.registered("optimizer", minimize=minimize)
        self.states(box.scene(optimizer={"type": "py_test"}))
        self.assertTrue(all("at work already" in text for text in refused))

    def test_a_search_in_the_background_calls_python(self):
        scene = box.scene(optimizer={"type": "py_sampler"}, init={"from": "global_search"},
                          tracker={"recovery": {"run": "background"}})
        tracker = box.session(scene).tracker(self.rig.cameras)
        for i in range(3):
            tracker.track(*self.rig.pictures(i), i / 30)  # arrays that nobody else holds
        del tracker  # waits for the search, which needs the GIL

    def test_a_source_in_python_is_read_by_another_thread(self):
        threads = set()

        class Source(plugins_test.Rendered):
            def __iter__(self):
                for frame in super().__iter__():
                    threads.add(threading.get_ident())
                    yield frame

        hypotrack.register("source", "py_threads", Source)
        seen = []
        box.session(box.scene(source={"type": "py_threads", "frames": 4})).run(
            on_frame=lambda f, s, e: seen.append(f.index))
        self.assertEqual(seen, [0, 1, 2, 3])
        self.assertTrue(threads)

    def test_ctrl_c_ends_a_frame(self):
        program = """
import box, hypotrack, signal, sys, threading, os, time
rig = box.Rig()
tracker = box.session(box.scene(budget={"evaluations": 50000000}, optimizer={
    "type": "pso", "particles": 5000, "generations": 10000})).tracker(rig.cameras)
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    tracker.track(*rig.pictures(0), 0.0)
except KeyboardInterrupt:
    solution = None
    print("interrupted")
"""
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                              timeout=120, cwd=os.path.dirname(__file__))
        self.assertEqual(done.stdout, "interrupted\n", done.stderr)

    def test_ctrl_c_in_a_plugin_ends_a_run(self):
        program = """
import box, hypotrack, os, plugins_test, signal, time
def minimize(self, cost, region, budget, seed):
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(60)
plugins_test.registered("optimizer", minimize=minimize)
try:
    box.session(box.scene(optimizer={"type": "py_test"}, source=box.synthetic())).run()
except KeyboardInterrupt:
    print("interrupted")
"""
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                              timeout=120, cwd=os.path.dirname(__file__))
        self.assertEqual(done.stdout, "interrupted\n", done.stderr)

    def test_the_interpreter_ends_while_a_search_in_the_background_calls_python(self):
        program = """
import box, hypotrack, plugins_test, time
rig = box.Rig()
tracker = box.session(box.scene(optimizer={"type": "py_sampler"}, init={"from": "global_search"},
                                tracker={"recovery": {"run": "background"}})).tracker(rig.cameras)
for i in range(2):
    tracker.track(*rig.pictures(i), i / 30)
print("done")
"""
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                                  timeout=120, cwd=os.path.dirname(__file__))
            self.assertEqual((done.stdout, done.returncode), ("done\n", 0), done.stderr)

    def test_the_interpreter_ends_while_daemon_threads_work(self):
        program = """
import box, hypotrack, plugins_test, threading
at_work = threading.Event()
def frame(*_):
    at_work.set()
session = box.session(box.scene(source=box.synthetic(3000), optimizer={"type": "py_sampler"}))
threading.Thread(target=lambda: session.run(on_frame=frame), daemon=True).start()
rig = box.Rig()
cost = box.session().frame_cost(rig.cameras)
cost.look(rig.pictures(0), rig.state(0))
def evaluate():
    while True:
        cost([rig.state(0)] * 500)
threading.Thread(target=evaluate, daemon=True).start()
at_work.wait(60)
print("done")
"""
        for _ in range(3):
            done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                                  timeout=120, cwd=os.path.dirname(__file__))
            self.assertEqual((done.stdout, done.returncode), ("done\n", 0), done.stderr)

    def test_the_interpreter_ends_with_trackers_alive(self):
        program = """
import box, hypotrack, plugins_test
rig = box.Rig()
session = box.session(box.scene(optimizer={"type": "py_sampler"},
                                objective=[{"type": "py_count"}, {"type": "stereo_color"}]))
import threads_test
tracker = session.tracker(rig.cameras)
views = rig.pictures(0)
tracker.track(*views, 0.0)
cost = session.frame_cost(rig.cameras)
cost.look(views, rig.state(0))
print("done")
"""
        done = subprocess.run([sys.executable, "-c", "import threads_test\n" + program],
                              capture_output=True, text=True, timeout=120,
                              cwd=os.path.dirname(__file__))
        self.assertEqual((done.stdout, done.returncode), ("done\n", 0), done.stderr)


@hypotrack.plugin("objective", "py_count")
class Count:
    """The share of pixels that are covered, from any thread."""

    def costs(self, hypotheses):
        return np.mean([(d > 0).mean(axis=(1, 2)) for d in hypotheses.inverse_depths], axis=0)


if __name__ == "__main__":
    unittest.main()
