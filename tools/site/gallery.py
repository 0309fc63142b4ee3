#!/usr/bin/env python3
"""Makes the gallery's pictures: gallery.py ROOT HYPOTRACK OUT [--frames N] [SCENE...].

Each scene of configs/scenes that this machine can open becomes OUT/SCENE.webp: the left picture beside the tracked
models. It needs ffmpeg. SCENE chooses scenes by their path below configs/scenes, without `.yaml`.
"""
import argparse
import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PANE = (320, 240)
EVERY = 2  # frames of the recording for one of the picture


def scenes(root):
    """Returns (name, file) of each scene, demo first; a file without a source, such as one of gestures, is none."""
    folder = root / "configs/scenes"
    found = [(str(f.relative_to(folder).with_suffix("")), f) for f in folder.rglob("*.yaml")
             if re.search(r"^source:", f.read_text(), re.M)]
    return sorted(found, key=lambda scene: (scene[0] != "demo", "/" in scene[0], scene[0]))


def run(command):
    """Runs a program; returns its last line if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return "" if done.returncode == 0 else (done.stdout.strip().split("\n")[-1] or f"{command[0]} failed")


def part_of_interest(recording, size):
    """Returns ffmpeg's crop of the pictures: a box of the pane's shape around all masks of the models."""
    masks = ["ffmpeg", "-v", "info", "-i", str(recording / "left_mask_%06d.png"), "-vf", "bbox", "-f", "null", "-"]
    text = subprocess.run(masks, capture_output=True, text=True).stderr
    boxes = [tuple(map(int, box)) for box in re.findall(r"x1:(\d+) x2:(\d+) y1:(\d+) y2:(\d+)", text)]
    lefts, rights, tops, bottoms = zip(*boxes) if boxes else ((0,), (size[0],), (0,), (size[1],))
    x, y, w, h = min(lefts), min(tops), max(rights) - min(lefts), max(bottoms) - min(tops)
    center = x + w / 2, y + h / 2
    width = max(1.25 * w, 1.25 * h * PANE[0] / PANE[1])
    width = min(width, size[0], size[1] * PANE[0] / PANE[1])
    height = width * PANE[1] / PANE[0]
    left = min(max(center[0] - width / 2, 0), size[0] - width)
    top = min(max(center[1] - height / 2, 0), size[1] - height)
    return f"crop={int(width)}:{int(height)}:{int(left)}:{int(top)}"


def size_of(video):
    shown = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=width,height", "-of",
                            "json", video], capture_output=True, text=True, check=True)
    stream = json.loads(shown.stdout)["streams"][0]
    return stream["width"], stream["height"]


def make(hypotrack, scene, frames, picture):
    """Renders and tracks a scene and joins both. Returns the reason if that is not possible here."""
    with tempfile.TemporaryDirectory() as scratch:
        recording, result = Path(scratch, "recording"), Path(scratch, "result")
        failed = run([hypotrack, "synth", scene, "--out", recording, "--frames", str(frames)])
        failed = failed or run([hypotrack, "run", recording / "scene.yaml", "--out", result])
        if failed:
            return failed
        pictures = next(recording.glob("left_*[0-9].*")).suffix
        part = f"{part_of_interest(recording, size_of(result / 'overlay.mp4'))},scale={PANE[0]}:{PANE[1]}"
        picture.parent.mkdir(parents=True, exist_ok=True)
        drawn = picture.with_suffix(".part.webp")  # what an interrupt leaves is no picture
        failed = run(["ffmpeg", "-v", "error", "-y", "-framerate", "30", "-i", recording / f"left_%06d{pictures}", "-i",
                    result / "overlay.mp4", "-filter_complex",
                    f"[0]{part}[a];[1]settb=1/30,setpts=N,{part}[b];[a][b]hstack,framestep={EVERY}",
                    "-c:v", "libwebp_anim", "-loop", "0", "-q:v", "50", "-compression_level", "6", drawn])
        if not failed:
            drawn.rename(picture)
        return failed


def summary(scene):
    """Returns the first sentence of the comment at the top of a scene."""
    lines = []
    for line in scene.read_text().split("\n"):
        if not line.startswith("# "):
            break
        lines.append(line[2:])
    return re.split(r"(?<=[.])\s", " ".join(lines))[0]


def page(root, pictures, pages):
    """Returns the gallery's page, and copies its pictures. Links are from docs/."""
    lines = ["---\nhide: [navigation, toc]\n---\n\n# Gallery\n", "Left: the left picture. Right: the tracked models on it. These are the scenes of "
             "[configs/scenes](../configs/scenes) that can be rendered; the others need recordings that their files name.\n",
             '<div class="gallery" markdown>\n']
    for name, scene in scenes(root):
        picture = pictures / f"{name}.webp"
        if not picture.exists():
            continue
        to = pages / "gallery" / f"{name}.webp"
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, to)
        lines.append(f'<div markdown>\n\n<img alt="{html.escape(name)}: pictures and tracked models" loading="lazy" width="{2 * PANE[0]}" '
                     f'height="{PANE[1]}" src="gallery/{name}.webp">\n\n'
                     f"[{name}](../configs/scenes/{name}.yaml): {summary(scene)}\n\n</div>\n")
    return "\n".join(lines) + "\n</div>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=Path)
    parser.add_argument("hypotrack", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("scenes", nargs="*")
    args = parser.parse_intermixed_args()
    made = 0
    for name, scene in scenes(args.root):
        picture = args.out / f"{name}.webp"
        if args.scenes and name not in args.scenes:
            continue
        why = "" if picture.exists() else make(args.hypotrack.resolve(), scene, args.frames, picture)
        print(f"{name}: left out: {why}" if why else picture, flush=True)
        made += not why
    if not made:
        sys.exit("No scene could be made; see the reasons above")


if __name__ == "__main__":
    main()
