#!/usr/bin/env python3
"""Measures how old solutions of a live run are: live_latency.py HYPOTRACK [SCENE] [--tracker real]

Two MJPEG streams of this machine play frames of a rendered scene to and fro, 30 pairs per second. `hypotrack run --web`
tracks them, while a browser's connections take its pictures and states and a program reads the output `stream`.
Prints the time from the arrival of the pictures to the solution: a queue that grows would show in the thirds' medians.
"""
import argparse
import json
import pathlib
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

HERE = pathlib.Path(__file__).resolve().parents[2]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hypotrack", type=pathlib.Path)
    parser.add_argument("scene", nargs="?", default=HERE / "configs/scenes/demo.yaml", help="a rendered scene of one hand")
    parser.add_argument("--tracker", default="real_time")
    parser.add_argument("--played", type=int, default=20, help="frames of the scene")
    parser.add_argument("--frames", type=int, default=300, help="frames that are tracked")
    return parser.parse_args()


def wait_for(condition, run):
    """Waits until a condition holds, unless the run ends."""
    while not condition():
        if run.poll() is not None:
            raise SystemExit(f"the run or a stream ended with {run.returncode}")
        time.sleep(0.05)


def record(options, folder):
    """Renders the scene, and lays its pictures in the order of the play."""
    subprocess.run([options.hypotrack, "record", options.scene, "--frames", str(options.played), "--format", "jpeg",
                    "--out", folder / "recording"], check=True, stdout=subprocess.DEVNULL)
    for view in "left", "right":
        for i in range(options.played):
            picture = folder / f"recording/{view}_{i:06}.jpg"
            (folder / f"{view}_{i:06}.jpg").hardlink_to(picture)
            (folder / f"{view}_{2 * options.played - 1 - i:06}.jpg").hardlink_to(picture)


def play(folder, view):
    """Starts a stream and returns its process and address."""
    port = folder / f"port_{view}"
    server = subprocess.Popen([sys.executable, HERE / "tests/support/mjpeg_server.py", folder / f"{view}_*.jpg",
                               "--port-file", port])
    wait_for(port.exists, server)
    return server, f"http://127.0.0.1:{port.read_text()}/stream"


def take(address):
    """Takes what a browser would, until the run ends."""
    def loop():
        try:
            with urllib.request.urlopen(address) as answer:
                while answer.read1():
                    pass
        except OSError:
            pass  # the run ended
    threading.Thread(target=loop, daemon=True).start()


def read(folder, run):
    """Returns the states and the ages of the solutions, in milliseconds."""
    reader = socket.socket(socket.AF_UNIX)
    wait_for((folder / "solutions").exists, run)
    for attempt in range(20):  # the file is there before anybody listens
        try:
            reader.connect(str(folder / "solutions"))
            break
        except ConnectionRefusedError:
            time.sleep(0.05 * attempt)
    lines = reader.makefile()
    next(lines)
    return [(next(iter(line["models"].values()))["status"], 1000 * line["age"])
            for line in map(json.loads, lines) if "age" in line]


def report(solutions):
    ages = [age for _, age in solutions]
    third = len(ages) // 3
    tracked = sum(status == "tracked" for status, _ in solutions)
    print(f"{len(ages)} solutions, {tracked} tracked; age: median {statistics.median(ages):.0f} ms, "
          f"95 % below {statistics.quantiles(ages, n=20)[-1]:.0f} ms; medians of thirds "
          + " ".join(f"{statistics.median(part):.0f}" for part in (ages[:third], ages[third:-third], ages[-third:])))


def main():
    options = arguments()
    options.hypotrack = options.hypotrack.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        record(options, folder)
        servers, run = [], None
        try:
            for view in "left", "right":
                servers.append(play(folder, view))
            left, right = (address for _, address in servers)
            subprocess.run([options.hypotrack, "new", "scene", "scene.yaml", "--left", left, "--right", right,
                            "--calibration", "recording/calibration.yaml", "--model", "hand", "--tracker", options.tracker], cwd=folder,
                           check=True, stdout=subprocess.DEVNULL)
            with open(folder / "log", "w", encoding="utf-8") as log:
                run = subprocess.Popen([options.hypotrack, "run", "scene.yaml", "--out", "result", "--web", "0", "--frames",
                                        str(options.frames), "--set", "output.also={type: stream, socket: solutions}"],
                                       cwd=folder, stdout=log, stderr=log)
            page = re.compile(r"live view: (\S+)/")
            wait_for(lambda: page.search((folder / "log").read_text()), run)
            for part in "/events", "/pictures/row":
                take(page.search((folder / "log").read_text())[1] + part)
            solutions = read(folder, run)
            if run.wait() != 0 or len(solutions) < 3:
                raise SystemExit((folder / "log").read_text())
            report(solutions)
        finally:
            for process in [server for server, _ in servers] + ([run] if run else []):
                process.kill()


if __name__ == "__main__":
    main()
