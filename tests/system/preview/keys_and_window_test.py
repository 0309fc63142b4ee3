#!/usr/bin/env python3
"""Steers a run by the keys of its window, on a virtual display.

usage: keys_and_window_test.py HYPOTRACK
Exits with 77 (skipped), saying why, where there is no virtual display or nothing that presses keys.
"""
import ctypes
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

SKIPPED = 77
PROGRAM = sys.argv[1]
INTERRUPTED = 130

SCENE = """models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
source:
  type: synthetic
  frames: 1000000
  cameras: {width: 160, height: 120, focal_px: 160, baseline_mm: 80}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400], rotation_deg: [20, 30, 0]}}}
    - {frame: 4, pose: {box: {position_mm: [20, 10, 420], rotation_deg: [20, 40, 10]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 8, generations: 4}
tile: {size: 32}
init: {from: truth}
output: {overlay: false, worst_frames: 0}
"""


def xdotool(*words):
    return subprocess.run(("xdotool", *words), capture_output=True, text=True, check=False, timeout=30).stdout


def close_by_mouse(window):
    """Tells a window's program what a click on the window's cross tells it."""
    class Message(ctypes.Structure):
        _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                    ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message", ctypes.c_ulong),
                    ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("room", ctypes.c_long * 24)]
    client_message = 33
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x.XOpenDisplay(None))
    message = Message(type=client_message, window=window, format=32,
                      message=x.XInternAtom(display, b"WM_PROTOCOLS", 0))
    message.data[0] = x.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
    x.XSendEvent(display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(message))
    x.XCloseDisplay(display)


class PreviewTest(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="hypotrack_preview_")
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)
        self.out = self.folder / "out"
        (self.folder / "scene.yaml").write_text(SCENE)

    def start(self, *more):
        """Starts a run, waits for its window and measures how long 15 frames take (pause_s)."""
        with open(self.folder / "err", "w") as err:
            self.run_ = subprocess.Popen((PROGRAM, "run", self.folder / "scene.yaml", "--out", self.out,
                                          "--preview", *more), stdout=subprocess.DEVNULL, stderr=err)
        self.addCleanup(self.run_.wait)
        self.addCleanup(self.run_.kill)
        self.until(lambda: self.frames() > 2)
        self.window = self.until(self.focused)
        begun, frames = time.monotonic(), self.frames()
        self.until(lambda: self.frames() > frames + 15)
        self.pause_s = max(1.5, time.monotonic() - begun)

    @staticmethod
    def focused():
        """Gives the run's window the keys and returns it; None while there is none or it has not got them."""
        found = xdotool("search", "--onlyvisible", "--name", "^hypotrack run$").split()
        if not found:
            return None
        xdotool("windowfocus", found[-1])
        return found[-1] if xdotool("getwindowfocus", "-f").strip() == found[-1] else None

    def within(self, seconds, found):
        """Waits until something is true, and returns it; None if the time is over before."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            over = self.run_.poll() is not None
            value = found()
            if value:
                return value
            self.assertFalse(over, self.said())
            time.sleep(0.05)
        return None

    def until(self, found):
        """Waits until something is true, and returns it."""
        value = self.within(120, found)
        if not value:
            self.fail("waited for two minutes: " + self.said())
        return value

    def said(self):
        return (self.folder / "err").read_text()

    def press(self, key, happened):
        """Presses a key until something has happened, and returns that: a busy window may miss a key."""
        for _ in range(5):
            xdotool("key", key)
            value = self.within(4 * self.pause_s, happened)
            if value:
                return value
        self.fail(f"the key {key} does nothing: " + self.said())

    def frames(self):
        """Returns the number of frames whose results are written."""
        table = self.out / "track.csv"
        return len(table.read_text().splitlines()) - 1 if table.exists() else 0

    def set(self, key):
        """Presses a key whose effect shows at the next frame only."""
        xdotool("key", key)
        time.sleep(self.pause_s)  # a window that is given two keys at once may miss the first

    def stopped(self):
        """Returns the number of frames if none is added for the time of 15 frames."""
        before = self.frames()
        time.sleep(self.pause_s)
        return before if self.frames() == before else None

    def pause(self):
        """Pauses and returns the number of frames then."""
        return self.press("space", self.stopped)

    def step(self, key="n"):
        """Advances a paused run by one frame."""
        frames = self.frames()
        self.press(key, lambda: self.frames() == frames + 1)

    def end(self, frames, key="q"):
        """Ends the run by a key; the files must hold the frames."""
        self.press(key, self.ended)
        self.expect_end(frames)

    def ended(self):
        try:
            self.run_.wait(1)
        except subprocess.TimeoutExpired:
            return False
        return True

    def expect_end(self, frames=None):
        """Waits for the end; the files must hold the frames."""
        self.assertEqual(self.run_.wait(120), INTERRUPTED, self.said())
        self.assertIn("the files hold the frames so far", self.said())
        self.assertTrue((self.out / "track.csv").exists())
        if frames is not None:
            self.assertEqual(self.frames(), frames)

    def test_space_pauses_and_n_steps(self):
        self.start()
        frames = self.pause()
        self.step()
        self.step("period")
        time.sleep(0.3)
        self.assertEqual(self.frames(), frames + 2)
        self.press("space", lambda: self.frames() > frames + 5)
        self.end(None)

    def test_escape_ends_a_paused_run(self):
        self.start()
        frames = self.pause()
        self.end(frames, "Escape")

    def test_a_window_closed_by_the_mouse_ends_the_run(self):
        self.start()
        frames = self.pause()
        close_by_mouse(int(self.window))
        self.expect_end(frames)

    def test_ctrl_c_ends_a_paused_run(self):
        self.start()
        frames = self.pause()
        self.run_.send_signal(signal.SIGINT)
        self.expect_end(frames)

    def window_process(self):
        """Returns the number of the process that shows the window."""
        children = pathlib.Path(f"/proc/{self.run_.pid}/task").glob("*/children")
        return int("".join(each.read_text() for each in children))

    def test_a_run_goes_on_when_its_window_fails(self):
        self.start()
        frames = self.pause()
        os.kill(self.window_process(), signal.SIGKILL)
        self.until(lambda: self.frames() > frames + 3)
        warning = "warning: the run goes on without a preview: the window's process ended with code 137"
        self.until(lambda: warning in self.said())
        self.run_.send_signal(signal.SIGINT)
        self.expect_end()

    def test_a_window_that_hangs_does_not_hold_up_the_end(self):
        self.start()
        frames = self.pause()
        os.kill(self.window_process(), signal.SIGSTOP)
        self.run_.send_signal(signal.SIGINT)
        self.expect_end(frames)

    def test_a_snapshot_has_views_and_pose(self):
        self.start()
        frames = self.pause()
        name = f"snapshot_{frames - 1:06}"
        self.press("s", lambda: name in self.said())
        self.end(frames)
        self.assertEqual((self.out / f"{name}.png").read_bytes()[1:4], b"PNG")
        init = f"init={{from: file, file: {self.out / (name + '.yaml')}}}"
        subprocess.run((PROGRAM, "validate", self.folder / "scene.yaml", "--set", init), check=True,
                       capture_output=True)

    def test_a_restarted_run_searches_anew(self):
        self.start()
        frames = self.pause()
        self.set("r")
        self.step()
        evaluations = [int(line.split(",")[4]) for line in
                       (self.out / "track.csv").read_text().splitlines()[1:]]
        self.assertGreater(evaluations[-1], 10 * min(evaluations[1:-1]))
        self.end(frames + 1)

    def test_recorded_pictures_can_be_tracked(self):
        self.start()
        frames = self.pause()
        self.set("v")
        for _ in range(3):
            self.step()
        self.press("v", lambda: "3 frames are recorded" in self.said())
        self.step()
        self.set("v")
        self.step()
        self.end(frames + 5)  # ends the second recording, too
        for first, count in ((frames, 3), (frames + 4, 1)):
            recording = self.out / f"recording_{first:06}"
            again = self.folder / f"again_{first}"
            run = subprocess.run((PROGRAM, "run", recording / "scene.yaml", "--out", again),
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stderr)
            lines = (again / "track.csv").read_text().splitlines()[1:]
            self.assertEqual([int(line.split(",")[0]) for line in lines], list(range(count)))

    def test_window_and_page_steer_the_same_run(self):
        if "(not installed)" in subprocess.run((PROGRAM, "--help"), capture_output=True, text=True,
                                                 check=True).stdout:
            self.skipTest("the page is part of the lab, which is absent")
        self.start("--web", "0")
        page = re.search(r"live view: (http://\S+)\n", self.said()).group(1)

        def post(command):
            urllib.request.urlopen(urllib.request.Request(page + command, method="POST")).close()

        def run():
            return re.search(r'"run":"(\w+)"', urllib.request.urlopen(page + "state").read().decode()).group(1)

        post("pause")
        self.until(lambda: run() == "paused")
        self.press("space", lambda: run() == "runs")
        self.press("space", lambda: run() == "paused")
        frames = self.frames()
        post("step")
        self.until(lambda: self.frames() == frames + 1)
        self.end(frames + 1)

    def test_without_a_display_nothing_is_written(self):
        for display, found in (("", "neither DISPLAY nor WAYLAND_DISPLAY is set"),
                               (":98765", "the display :98765 cannot be reached")):
            environment = {**os.environ, "DISPLAY": display}
            ended = subprocess.run((PROGRAM, "run", self.folder / "scene.yaml", "--out", self.out, "--preview"),
                                   capture_output=True, text=True, check=False, env=environment)
            self.assertEqual(ended.returncode, 1)
            self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)
            self.assertIn(found, ended.stderr)
            self.assertIn("--web", ended.stderr)
            self.assertFalse(self.out.exists())


if __name__ == "__main__":
    for needed, package in (("Xvfb", "xvfb"), ("xvfb-run", "xvfb"), ("xdotool", "xdotool")):
        if not shutil.which(needed):
            print(f"skipped: {needed} is not installed (package {package})")
            sys.exit(SKIPPED)
    if "HYPOTRACK_ON_VIRTUAL_DISPLAY" in os.environ:
        unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
    own = {k: v for k, v in os.environ.items() if k not in ("WAYLAND_DISPLAY", "QT_QPA_PLATFORM")}
    own["HYPOTRACK_ON_VIRTUAL_DISPLAY"] = "1"
    # A server without clients for a moment would start anew, and refuse those that come then.
    screen = "-screen 0 1280x720x24 -noreset"
    sys.exit(subprocess.run(("xvfb-run", "-a", "-s", screen, sys.executable, __file__, *sys.argv[1:]), env=own,
                            check=False).returncode)
