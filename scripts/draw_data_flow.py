#!/usr/bin/env python3
"""Draws the diagrams of docs/concepts.md from text: draw_data_flow.py [--check] [FILE.txt ...].

Writes FILE.svg beside each text; without files, all of docs/pictures/*.txt. With --check it writes nothing
and fails if a picture is not what its text says. The first word of a line says what it is:

  flow | sequence                      boxes in a grid | messages between participants
  size WIDTH HEIGHT GAP_X GAP_Y        of a flow's boxes, pixels
  plugin|core NAME COLUMN ROW TITLE / TEXT         box of a flow
  plugin|core NAME TITLE                           participant of a sequence
  FROM > TO : LABEL                    arrow; two of opposite directions lie side by side
  NAME : TEXT                          step that a participant makes alone
  frame NAME NAME TEXT                 dashed frame around two boxes
  loop NAME NAME TEXT ... end          dashed frame around messages
  key PLUGIN TEXT | CORE TEXT          legend
"""
import sys
import textwrap
from html import escape
from pathlib import Path

STYLE = """<style>
text{font:13px sans-serif;fill:#1f2328}.title{font-weight:600;font-size:14px}.label{font-size:12px;fill:#59636e}
.page{fill:#fff}.plugin{fill:#ddf4ff;stroke:#0969da}.core{fill:#f6f8fa;stroke:#818b98}
.line{fill:none;stroke:#59636e;stroke-width:1.5}.dashed{fill:none;stroke:#bc4c00;stroke-width:1.5;stroke-dasharray:5 4}
.frame{fill:#bc4c00;font-size:12px}.life{stroke:#818b98;stroke-dasharray:2 4}.head{fill:#59636e}
@media(prefers-color-scheme:dark){text{fill:#e6edf3}.label{fill:#9198a1}.page{fill:#0d1117}
.plugin{fill:#0c2d6b;stroke:#4493f8}.core{fill:#21262d;stroke:#6e7681}.line{stroke:#9198a1}.head{fill:#9198a1}
.dashed{stroke:#f0883e}.frame{fill:#f0883e}.life{stroke:#6e7681}}
</style>
<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto"
 markerUnits="userSpaceOnUse"><path class="head" d="M0 0 8 4 0 8z"/></marker></defs>"""


def text_width(text, size=12):
    return 0.56 * size * len(text)


class Picture:
    def __init__(self):
        self.parts = []

    def rect(self, x, y, width, height, kind):
        self.parts.append(f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="6" class="{kind}"/>')

    def text(self, x, y, text, kind="", anchor="middle", behind=False):
        if behind:  # hides the lines behind a label
            width = text_width(text) + 6
            left = x - (width / 2 if anchor == "middle" else 3)
            self.parts.append(f'<rect x="{left:g}" y="{y - 11:g}" width="{width:g}" height="15" class="page"/>')
        of_kind = f' class="{kind}"' if kind else ""
        self.parts.append(f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}"{of_kind}>{escape(text)}</text>')

    def arrow(self, *points):
        path = "M" + " L".join(f"{x:g} {y:g}" for x, y in points)
        self.parts.append(f'<path class="line" marker-end="url(#head)" d="{path}"/>')

    def box(self, x, y, width, height, kind, title, text=""):
        self.rect(x, y, width, height, kind)
        lines = textwrap.wrap(text, int((width - 12) / text_width("n", 13)))
        top = y + height / 2 - 8.5 * len(lines) + 5
        self.text(x + width / 2, top, title, "title")
        for i, line in enumerate(lines):
            self.text(x + width / 2, top + 17 * (i + 1), line)

    def svg(self, width, height, source):
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
            f'height="{height:g}">', f"<!-- made from {source} by scripts/draw_data_flow.py -->", STYLE,
            f'<rect class="page" width="{width:g}" height="{height:g}" rx="8"/>', *self.parts, "</svg>", ""])


def split_label(line):
    """Splits `FROM > TO : LABEL` or `NAME : LABEL` into names and label."""
    names, _, label = line.partition(" : ")
    return [name.strip() for name in names.split(">")], label.strip()


def draw_flow(lines, source):
    picture, boxes, arrows, frames, key = Picture(), {}, [], [], None
    width, height, gap_x, gap_y = 160, 70, 40, 40
    margin, top = 24, 36
    for line in lines:
        word, _, rest = line.partition(" ")
        if word == "size":
            width, height, gap_x, gap_y = map(float, rest.split())
        elif word in ("plugin", "core"):
            name, column, row, content = rest.split(maxsplit=3)
            title, _, text = content.partition(" / ")
            x, y = margin + int(column) * (width + gap_x), top + int(row) * (height + gap_y)
            boxes[name] = (x, y, int(column), int(row), word, title, text)
        elif word == "frame":
            frames.append(rest.split(maxsplit=2))
        elif word == "key":
            key = [part.strip() for part in rest.split("|")]
        else:
            arrows.append(split_label(line))

    for first, last, text in frames:
        (x, y, *_), (right, bottom, *_) = boxes[first], boxes[last]
        picture.rect(x - 8, y - 10, right - x + width + 16, bottom - y + height + 20, "dashed")
        picture.text(right + width, bottom + height + 25, text, "frame", "end")
    pairs = {tuple(names) for names, _ in arrows}
    labels = []
    for (start, end), label in arrows:
        x0, y0, column0, row0, *_ = boxes[start]
        x1, y1, column1, row1, *_ = boxes[end]
        if row0 == row1:  # along a row, side by side with the arrow back
            y = y0 + height / 2
            if (end, start) in pairs:
                y += 12 if column1 < column0 else -12
            left, right = (x0 + width, x1) if column1 > column0 else (x0, x1 + width)
            picture.arrow((left, y), (right, y))
            above = y + 16 if (end, start) in pairs and column1 < column0 else y - 6
            labels.append(((left + right) / 2, above, label, "middle", False))
        elif column0 == column1:  # along a column
            x = x0 + width / 2
            from_y, to_y = (y0 + height, y1) if row1 > row0 else (y0, y1 + height)
            picture.arrow((x, from_y), (x, to_y))
            labels.append((x + 8, (from_y + to_y) / 2 + 4, label, "start", True))
        else:  # along the row first, then along the column
            x, y = x1 + width / 2, y0 + height / 2
            from_x = x0 if column1 < column0 else x0 + width
            picture.arrow((from_x, y), (x, y), (x, y1 + height if row1 < row0 else y1))
            labels.append(((from_x + x) / 2, y - 6, label, "middle", False))
    for name in boxes:
        x, y, _, _, kind, title, text = boxes[name]
        picture.box(x, y, width, height, kind, title, text)
    for x, y, label, anchor, behind in labels:
        if label:
            picture.text(x, y, label, "label", anchor, behind)
    right = max(box[0] for box in boxes.values()) + width + margin
    bottom = max(box[1] for box in boxes.values()) + height
    if key:
        for i, (kind, text) in enumerate(zip(("plugin", "core"), key)):
            picture.rect(margin, bottom - 44 + 26 * i, 22, 16, kind)
            picture.text(margin + 30, bottom - 31 + 26 * i, text, "", "start")
    return picture.svg(right, bottom + margin, source)


def draw_sequence(lines, source):
    spacing, step, margin, head, column_width = 158, 32, 24, 34, 112
    names, steps = {}, []
    for line in lines:
        word, _, rest = line.partition(" ")
        if word in ("plugin", "core"):
            name, title = rest.split(maxsplit=1)
            names[name] = (margin + column_width / 2 + len(names) * spacing, word, title)
        else:
            steps.append(line)
    drawing, loops, y = Picture(), [], margin + head + 30
    for line in steps:
        word, _, rest = line.partition(" ")
        if word == "loop":
            first, last, text = rest.split(maxsplit=2)
            loops.append((names[first][0], names[last][0], y - 16, text))
            y += 18
            continue
        if word == "end":
            left, right, top, text = loops.pop()
            drawing.rect(left - 46, top, right - left + 150, y - top - 16, "dashed")
            drawing.text(left - 38, top + 15, text, "frame", "start", True)
            y += 10
            continue
        who, label = split_label(line)
        x0 = names[who[0]][0]
        if len(who) == 2:
            x1 = names[who[1]][0]
            drawing.text((x0 + x1) / 2, y - 6, label, "label", "middle", True)
            drawing.arrow((x0, y), (x1, y))
        else:
            width = text_width(label) + 16
            drawing.rect(x0 - width / 2, y - 14, width, 22, names[who[0]][1])
            drawing.text(x0, y + 1, label, "label")
        y += step
    height = y + 4
    picture = Picture()
    for x, kind, title in names.values():
        picture.parts.append(f'<line class="life" x1="{x:g}" y1="{margin + head:g}" x2="{x:g}" y2="{height - 12:g}"/>')
        picture.box(x - column_width / 2, margin, column_width, head, kind, title)
    picture.parts += drawing.parts
    return picture.svg(max(x for x, *_ in names.values()) + column_width / 2 + margin, height, source)


def main():
    root = Path(__file__).resolve().parent.parent
    arguments = [a for a in sys.argv[1:] if a != "--check"]
    files = [Path(a) for a in arguments] or sorted((root / "docs/pictures").glob("*.txt"))
    stale = []
    for file in files:
        lines = [line.strip() for line in file.read_text().splitlines() if line.strip() and line[0] != "#"]
        draw = {"flow": draw_flow, "sequence": draw_sequence}[lines[0]]
        svg = draw(lines[1:], file.name)
        target = file.with_suffix(".svg")
        if "--check" not in sys.argv:
            target.write_text(svg)
        elif not target.exists() or target.read_text() != svg:
            stale.append(target.name)
    if stale:
        print(f"{', '.join(stale)}: not what the text says; run scripts/draw_data_flow.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
