#!/usr/bin/env python3
"""Opens a report in headless Chromium and looks at it as a reader would.

usage: browser_test.py WRITE_BROWSER_STUDY HYPOTRACK
Exits with 77 (skipped), saying why, where Chromium or its driver are not installed.
"""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-dev-shm-usage", "--hide-scrollbars"]

try:
    from selenium import webdriver
    from selenium.common.exceptions import TimeoutException
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(SKIPPED)


def start_browser(profile):
    """Chromium with a fresh profile that notes its console and every request."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in FLAGS + ["--user-data-dir=" + profile]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


class ReportTest(unittest.TestCase):
    """One report for all tests; each opens it afresh."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="hypotrack_report_")
        study = pathlib.Path(cls.folder.name) / "study"
        subprocess.run([WRITE_STUDY, study], check=True)
        subprocess.run([PROGRAM, "report", study, "--replays", "2", "--no-images"], check=True,
                       stdout=subprocess.DEVNULL)
        single = next((study / "runs").glob("*_s1"))
        subprocess.run([PROGRAM, "report", single, "--no-images"], check=True,
                       stdout=subprocess.DEVNULL)
        after = pathlib.Path(cls.folder.name) / "after"
        shutil.copytree(study, after)
        for metrics in (after / "runs").glob("stereo_*/metrics.json"):
            numbers = json.loads(metrics.read_text())
            numbers["mean_error_mm"] -= 1
            metrics.write_text(json.dumps(numbers))
        subprocess.run([PROGRAM, "report", study, after], check=True, stdout=subprocess.DEVNULL)
        cls.changes_page = (after / "changes.html").as_uri()
        cls.study_page = (study / "report.html").as_uri()
        cls.run_page = (single / "report.html").as_uri()
        cls.browser = start_browser(cls.folder.name + "/profile")
        cls.browser.set_page_load_timeout(120)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.folder.cleanup()

    def open(self, page, width=1280, scheme="light"):
        self.browser.get("about:blank")
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)  # what came before
        self.browser.get(page)
        shown = ".table" if page == self.changes_page else ".plot svg"
        self.until(lambda: self.find(shown))

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def until(self, condition):
        return WebDriverWait(self.browser, 60).until(lambda _: condition())

    def find(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def replayed_run(self):
        """The address of a run with a replay."""
        return self.script("""
            var page = JSON.parse(document.getElementById('data').textContent);
            return hypotrack.runAddress(page.runs.find(function (run) { return run.replay; }));""")

    def picture(self):
        return self.find(".stage canvas")[0].screenshot_as_png

    def assert_quiet(self):
        """Nothing on the console and no request but for the page itself."""
        # The software WebGL notes when a screenshot makes it wait.
        messages = [entry["message"] for entry in self.browser.get_log("browser")
                    if entry["level"] in ("WARNING", "SEVERE")
                    and "GPU stall due to ReadPixels" not in entry["message"]]
        self.assertEqual(messages, [])
        requests = []
        for entry in self.browser.get_log("performance"):
            event = json.loads(entry["message"])["message"]
            if event["method"] == "Network.requestWillBeSent":
                requests.append(event["params"]["request"]["url"][:100])
        outside = [url for url in requests if not url.startswith(("file:", "data:", "about:"))]
        self.assertEqual(outside, [])
        self.assertLessEqual(len([url for url in requests if url.startswith("file:")]), 1)

    def assert_no_sideways_scroll(self):
        # Not innerWidth, which grows with what is too wide.
        self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), 390)
        self.assertEqual(self.script("return innerWidth"), 390)

    def test_overview_has_plots_with_marks_and_tables(self):
        self.open(self.study_page)
        charts = self.script("""
            return Array.from(document.querySelectorAll('.chart')).map(function (chart) {
              return [chart.id, chart.querySelectorAll('.mark-line path, .mark-rect path').length];
            });""")
        self.assertEqual([name for name, _ in charts],
                         ["plot-1-curve", "plot-2-success", "plot-3-heatmap", "plot-4-bars",
                          "plot-5-convergence", "plot-6-targets", "plot-7-performance_profile",
                          "plot-8-data_profile", "plot-9-expected_running_time"])
        for name, marks in charts:
            self.assertGreaterEqual(marks, 4, name)
        self.assertEqual(len(self.find(".table")), 3)
        self.assertGreaterEqual(len(self.find("td.best")), 3)
        self.assert_quiet()

    def test_texts_of_others_stay_texts(self):
        self.open(self.study_page)
        self.assertIn("</script><img src=x onerror=alert(1)>", self.browser.title)
        self.assertIn("</script><img", self.find("h1")[0].text)
        self.assertIn("</script><script>", self.find(".failures pre")[0].text)
        self.assertEqual(len(self.find("img")), 0)
        self.assert_quiet()

    def test_tables_sort_and_runs_are_found(self):
        self.open(self.study_page)
        heading = self.find("#table-1-stereo thead button")[3]  # after particles, generations, runs
        heading.click()
        first = "return document.querySelector('#table-1-stereo tbody td.best') !== null && " \
                "document.querySelector('#table-1-stereo tbody tr td.best') === " \
                "document.querySelector('#table-1-stereo tbody tr:first-child td.best')"
        self.assertTrue(self.script(first))
        before = len(self.find("tbody a"))
        self.find("#find")[0].send_keys("rgbd seed 2")
        self.assertLess(len(self.find("tbody a")), before)
        self.assertGreater(len(self.find("tbody a")), 0)

    def test_run_page_opens_and_its_replay_moves(self):
        self.open(self.study_page)
        self.script("location.hash = arguments[0]", self.replayed_run())
        self.until(lambda: self.find(".stage canvas"))
        self.until(lambda: len(self.find(".plot svg")) >= 4)
        self.assertGreaterEqual(len(self.find(".worst img")), 1)
        time.sleep(1)
        first = self.picture()
        self.script("""
            var slider = document.querySelector('.replay input[type=range]');
            slider.value = 8;
            slider.dispatchEvent(new Event('input'));""")
        time.sleep(1)
        second = self.picture()
        self.assertNotEqual(first, second)
        self.assertIn("frame 8", self.find(".replay output")[0].text)
        shown = self.script("""
            var canvas = document.querySelector('.stage canvas');
            var copy = document.createElement('canvas');
            copy.width = copy.height = 64;
            return new Promise(function (done) { requestAnimationFrame(function () {
              document.querySelectorAll('.replay button')[1].click();  // Reset view draws
              requestAnimationFrame(function () {
                var draw = copy.getContext('2d');
                draw.drawImage(canvas, 0, 0, 64, 64);
                var pixels = draw.getImageData(0, 0, 64, 64).data, seen = 0;
                for (var i = 3; i < pixels.length; i += 4) seen += pixels[i] > 0;
                done(seen);
              });
            }); });""")
        self.assertGreater(shown, 100)  # of 4096: the hand is in view
        self.assert_quiet()

    def test_run_page_of_a_traced_run_says_which_frames_failed_and_why(self):
        self.open(self.run_page)
        notes = " ".join(note.text for note in self.find(".note"))
        self.assertRegex(notes, r"Frames where the search failed \(the truth costs less, or there is no answer\): "
                                r".*\b36 to 38\.")
        self.assertRegex(notes, r"Frames where the objective failed \(the truth costs no less\): .*\b35, 39\.")
        self.assertGreaterEqual(len(self.find("#cost .mark-symbol.role-mark path")), 10)
        self.assertEqual(len(self.find("#cost .mark-line path")), 2)
        self.assert_quiet()

    def test_replay_plays_and_stops(self):
        self.open(self.study_page)
        self.script("location.hash = arguments[0]", self.replayed_run())
        self.until(lambda: self.find(".replay button"))
        self.find(".replay button")[0].click()
        self.until(lambda: self.script("return Number(document.querySelector("
                                       "'.replay input[type=range]').value)") > 2)
        self.script("location.hash = '#/'")
        self.until(lambda: self.find(".overview"))
        self.assert_quiet()

    def test_a_run_without_replay_says_so(self):
        self.open(self.study_page)
        address = self.script("""
            var page = JSON.parse(document.getElementById('data').textContent);
            return hypotrack.runAddress(page.runs.find(function (run) {
              return !run.replay && !run.failed; }));""")
        self.script("location.hash = arguments[0]", address)
        self.until(lambda: self.find(".run"))
        self.assertIn("no replay in this report", self.find(".run")[0].text)

    def test_a_single_run_is_a_page_of_its_own(self):
        self.open(self.run_page)
        self.assertEqual(len(self.find(".stage canvas")), 1)
        self.assertEqual(len(self.find("#error svg")), 1)
        self.assert_quiet()

    def test_a_study_before_and_after_a_change_is_one_page(self):
        self.open(self.changes_page, width=390)
        self.assertEqual(len(self.find(".table")), 2)
        cells = self.script("""
            return Array.from(document.querySelectorAll('#change-1 tbody tr')).map(function (row) {
              return row.querySelector('.detail').textContent;
            });""")
        self.assertEqual(len(cells), 6)
        for cell in cells:
            self.assertTrue(cell.startswith("−1.00"), cell)
        self.assertGreaterEqual(len(self.find("#change-2 .same")), 6)
        self.assert_no_sideways_scroll()
        self.assert_quiet()

    def test_tables_show_that_they_go_on_to_the_right(self):
        for width in (1280, 400):
            self.open(self.study_page, width=width)
            boxes = self.script("""
                return Array.from(document.querySelectorAll('.table .scrolled')).map(function (box) {
                  return [box.firstChild.scrollWidth > box.firstChild.clientWidth + 2,
                          box.querySelector('.more').offsetHeight > 0];
                });""")
            self.assertIn([True, True], boxes)
            for wide, told in boxes:
                self.assertEqual(told, wide)
            self.script("document.querySelectorAll('.scroll').forEach(function (scroll) {"
                        "  scroll.scrollLeft = 1e5; });")
            self.until(lambda: not self.find(".goes-right"))
            self.assertTrue(self.find(".goes-left"))

    def test_axes_end_where_the_data_ends(self):
        self.open(self.study_page)
        ends = self.script("""
            return ['plot-1-curve', 'plot-2-success'].map(function (id) {
              var chart = hypotrack.charts.find(function (c) { return c.plot.id === id; });
              return [chart.view.scale('x').domain()[1], chart.view.scale('y').domain()[1],
                      hypotrack.rangeOf(chart.plot, hypotrack.band)[1],
                      hypotrack.endOfRise(chart.plot)];
            });""")
        (curve_x, curve_y, most, _), (success_x, _, _, rise) = ends
        self.assertEqual([curve_x, curve_y], [64, most])
        self.assertEqual(success_x, rise)
        self.assertLess(rise, 50)  # where the table of shares ends

    def test_names_are_whole_where_there_is_room(self):
        self.open(self.study_page)
        long = "a method whose name has more words than others"
        texts = self.script("""
            var plot = {kind: 'bars', title: 't', color: {label: 'c', values: [arguments[0], 'b']},
                        x: {label: 'x', values: [arguments[0], 'short']}, y: {label: 'y'}, facets:
                        [{label: '', rows: [{x: arguments[0], color: 'b', mean: 1, sd: 0, n: 2}]}]};
            var chart = {plot: plot, width: 0, view: null,
                         holder: document.querySelector('.plot')};
            hypotrack.drawChart(chart);
            return chart.view.runAsync().then(function () {
              return Array.from(chart.holder.querySelectorAll('text')).map(function (text) {
                return text.textContent;
              });
            });""", long)
        self.assertEqual(texts.count(long), 2)  # in the legend and at the axis

    def test_lines_of_many_settings_can_be_told_apart(self):
        self.open(self.study_page)
        lines = self.script("""
            var names = Array.from({length: 24}, function (_, i) { return 'm' + i; });
            var rows = names.map(function (name, i) {
              return [1, 2].map(function (x) {
                return {x: x, color: name, mean: 4 * i, n: 1};
              });
            }).flat();
            var plot = {kind: 'performance_profile', title: 't', counted: 'frames',
                        color: {label: 'c', values: names}, x: {label: 'x'}, y: {label: 'y'},
                        facets: [{label: '', rows: rows}]};
            var chart = {plot: plot, width: 0, view: null,
                         holder: document.querySelector('.plot')};
            hypotrack.drawChart(chart);
            return chart.view.runAsync().then(function () {
              return ['.mark-line path', '.role-legend-symbol path'].map(function (marks) {
                return Array.from(chart.holder.querySelectorAll(marks)).map(function (path) {
                  return path.getAttribute('stroke') + ' ' + path.getAttribute('stroke-dasharray');
                });
              });
            });""")
        for kind in lines:  # those of the plot and those of its legend
            self.assertEqual(len(kind), 24)
            self.assertEqual(len(set(kind)), 24)

    def test_nothing_is_wider_than_a_phone(self):
        self.open(self.study_page, width=390)
        self.assert_no_sideways_scroll()
        self.script("location.hash = arguments[0]", self.replayed_run())
        self.until(lambda: self.find(".run .plot svg"))
        self.assert_no_sideways_scroll()
        self.assert_quiet()

    def test_plots_follow_the_colours_of_the_system(self):
        def colors():
            return self.script("""
                return [getComputedStyle(document.body).backgroundColor,
                        getComputedStyle(document.querySelector('.plot svg text')).fill];""")

        self.open(self.study_page)
        light = colors()
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        self.until(lambda: self.find(".plot svg text") and colors()[1] != light[1])
        self.assertNotEqual(colors()[0], light[0])
        self.open(self.study_page, scheme="dark")
        self.assertNotEqual(colors()[1], light[1])
        self.assert_quiet()


if __name__ == "__main__":
    WRITE_STUDY, PROGRAM = sys.argv[1:3]
    for needed in ("chromium", "chromedriver"):
        if not shutil.which(needed):
            print(f"skipped: {needed} is not installed")
            sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
