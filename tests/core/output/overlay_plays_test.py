#!/usr/bin/env python3
"""Plays the overlay of a run in headless Chromium.

usage: overlay_plays_test.py HYPOTRACK
Exits with 77 (skipped), saying why, where Chromium or its driver are not installed.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError:
    print("skipped: python3-selenium is not installed")
    sys.exit(SKIPPED)
if not shutil.which("chromium") or not shutil.which("chromedriver"):
    print("skipped: chromium or chromedriver is not installed")
    sys.exit(SKIPPED)

SCENE = """models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
source:
  type: synthetic
  frames: 12
  cameras: {width: 320, height: 240, focal_px: 320, baseline_mm: 80}
  keyframes:
    - {frame: 0, pose: {box: {position_mm: [0, 0, 400], rotation_deg: [20, 30, 0]}}}
    - {frame: 11, pose: {box: {position_mm: [20, 10, 420], rotation_deg: [20, 40, 10]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 8, generations: 4}
tile: {size: 32}
init: {from: truth}
output: {worst_frames: 0}
"""
PLAY = """const done = arguments[0], video = document.querySelector('video');
video.onended = () => done(`${video.videoWidth}x${video.videoHeight} ${video.duration.toFixed(1)}`);
video.onerror = () => done(`error ${video.error.message}`);
video.src = 'overlay.mp4'; video.muted = true; video.play();"""

with tempfile.TemporaryDirectory(prefix="hypotrack_overlay_") as name:
    folder = pathlib.Path(name)
    (folder / "scene.yaml").write_text(SCENE)
    subprocess.run([sys.argv[1], "run", folder / "scene.yaml", "--out", folder / "out"], check=True)
    page = folder / "out" / "page.html"
    page.write_text("<!doctype html><video></video>")
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
                 "--disable-dev-shm-usage", f"--user-data-dir={name}/profile"]:
        options.add_argument(flag)
    browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    try:
        browser.set_script_timeout(60)
        browser.get(page.as_uri())
        played = browser.execute_async_script(PLAY)
    finally:
        browser.quit()
    print("played:", played)
    sys.exit(0 if played == "320x240 0.4" else f"expected 320x240 for 0.4 s, found {played}")
