#!/usr/bin/env python3
"""make_euroc.py RECORDING OUT: a recording of `hypotrack synth` in the EuRoC folder layout.

Leaves the second camera's picture of frame 2 out.
"""
import pathlib
import re
import shutil
import sys

recording, out = map(pathlib.Path, sys.argv[1:])
text = (recording / "calibration.yaml").read_text()
matrices = [list(map(float, m.split(","))) for m in re.findall(r"^    K: \[(.*)\]", text, re.M)]
offsets = [list(map(float, t.split(","))) for t in re.findall(r"^    T: \[(.*)\]", text, re.M)]
width, height = re.search(r"image_width: (\d+)\s+image_height: (\d+)", text).groups()
for number, (name, k, t) in enumerate(zip(["left", "right"], matrices, offsets)):
    folder = out / f"cam{number}"
    (folder / "data").mkdir(parents=True)
    pose = [1, 0, 0, -t[0], 0, 1, 0, -t[1], 0, 0, 1, -t[2], 0, 0, 0, 1]
    (folder / "sensor.yaml").write_text(
        f"sensor_type: camera\nT_BS: {{cols: 4, rows: 4, data: {pose}}}\n"
        f"resolution: [{width}, {height}]\nintrinsics: [{k[0]}, {k[4]}, {k[2]}, {k[5]}]\n"
        "distortion_model: radial-tangential\ndistortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n")
    lines = ["#timestamp [ns],filename"]
    for i, picture in enumerate(sorted(recording.glob(f"{name}_0*.png"))):
        if number == 1 and i == 2:
            continue
        time = 1403636579763555584 + i * 33333333 + number * 1000000
        shutil.copy(picture, folder / "data" / f"{time}.png")
        lines.append(f"{time},{time}.png")
    (folder / "data.csv").write_text("\r\n".join(lines) + "\r\n")
