#!/usr/bin/env python3
"""Opens the live view of a run in headless Chromium and uses it as a viewer would.

usage: page_in_browser.py HYPOTRACK REPORT_TESTS
REPORT_TESTS: folder of the report's browser test, which starts the browser.
Exits with 77 (skipped), saying why, where Chromium or its driver are not installed.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = sys.argv[1]
sys.path.insert(0, sys.argv[2])
sys.dont_write_bytecode = True
from browser_test import (  # noqa: E402
    SKIPPED, By, TimeoutException, WebDriverWait, start_browser)

SCENE = """
models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
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
evaluate: {threads: 1}  # leaves processors to the browser
init: {from: truth}
output: {overlay: false, worst_frames: 0}
"""


class LiveViewTest(unittest.TestCase):
    """A run and a browser for all tests; each opens the page afresh."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="hypotrack_web_")
        cls.browser = start_browser(cls.folder.name + "/profile")
        cls.browser.set_page_load_timeout(120)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.folder.cleanup()

    def setUp(self):
        folder = pathlib.Path(self.folder.name)
        (folder / "scene.yaml").write_text(SCENE)
        with open(folder / "err", "w") as err:
            self.tracking = subprocess.Popen(
                [PROGRAM, "run", folder / "scene.yaml", "--out", folder / "out", "--web", "0"],
                stdout=subprocess.DEVNULL, stderr=err)
        found = None
        while not found and self.tracking.poll() is None:
            found = re.search(r"live view: (http://\S+)\n", (folder / "err").read_text())
            time.sleep(0.01)
        self.assertTrue(found, (folder / "err").read_text())
        self.page = found.group(1)

    def tearDown(self):
        self.tracking.terminate()
        self.tracking.wait()

    def open(self, width=1280):
        self.browser.get("about:blank")
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.get_log("browser")  # what came before
        # The page's streams never end: do not wait for them.
        self.browser.execute_script("location.href = arguments[0]", self.page)
        self.until(lambda: self.frame() is not None)
        self.until(lambda: self.picture_width() > 0)

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def until(self, condition):
        try:
            return WebDriverWait(self.browser, 120).until(lambda _: condition())
        except TimeoutException:
            log = (pathlib.Path(self.folder.name) / "err").read_text()
            self.fail(f"waited in vain: the page says {self.text('run')!r} in frame "
                      f"{self.frame()}, the browser {self.browser.get_log('browser')}, "
                      f"the run {log!r}")

    def text(self, name):
        return self.script("return (document.getElementById(arguments[0]) || {}).textContent", name)

    def frame(self):
        text = self.script("return (document.querySelector('#facts dd') || {}).textContent")
        return int(text.split()[0]) if text else None

    def picture_width(self):
        return self.script("return document.getElementById('pictures').naturalWidth")

    def press(self, name):
        self.browser.find_element(By.ID, name).click()

    def assert_quiet(self):
        messages = [entry["message"] for entry in self.browser.get_log("browser")
                    if entry["level"] in ("WARNING", "SEVERE")
                    and "GPU stall due to ReadPixels" not in entry["message"]]
        self.assertEqual(messages, [])

    def test_pictures_models_plots_and_the_3d_view_are_shown(self):
        self.open()
        self.assertEqual(self.picture_width(), 320)
        self.assertIn("box", self.text("models"))
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, ".plots canvas")), 3)
        self.press("pause")
        self.until(lambda: self.text("run") == "paused")
        stage = self.browser.find_element(By.CSS_SELECTOR, "#stage canvas")
        shown = stage.screenshot_as_png
        self.script("document.querySelector('#stage canvas').style.visibility = 'hidden'")
        self.assertNotEqual(stage.screenshot_as_png, shown, "the 3D view was empty")
        self.assert_quiet()

    def test_buttons_pause_step_and_resume(self):
        self.open()
        self.press("pause")
        self.until(lambda: self.text("run") == "paused")
        frame = self.frame()
        self.press("step")
        self.until(lambda: self.frame() == frame + 1)
        self.assertEqual(self.text("pause"), "Resume")
        self.press("pause")
        self.until(lambda: self.frame() > frame + 3)
        self.assertEqual(self.text("run"), "running")
        self.assert_quiet()

    def test_a_command_is_sent_again_when_its_connection_breaks(self):
        self.open()
        self.script("var real = fetch; window.fetch = function () {"
                    "  window.fetch = real; return Promise.reject(new TypeError('broken')); };")
        self.press("pause")
        self.until(lambda: self.text("run") == "paused")

    def test_a_narrow_page_has_the_views_below_each_other(self):
        self.open(width=400)
        self.assertEqual(self.picture_width(), 160)
        self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), 400)
        self.assert_quiet()

    def test_the_page_stays_and_says_so_when_the_run_has_ended(self):
        self.open()
        self.tracking.terminate()
        self.until(lambda: self.text("run") == "the run has ended")
        self.assertFalse(self.browser.find_element(By.ID, "pause").is_enabled())
        self.assertIsNotNone(self.frame())


if __name__ == "__main__":
    for needed in ("chromium", "chromedriver"):
        if not shutil.which(needed):
            print(f"skipped: {needed} is not installed")
            sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
