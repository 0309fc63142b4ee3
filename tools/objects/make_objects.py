#!/usr/bin/env python3
"""Makes the meshes and textures of configs/objects: scissors, drawer, laptop, lamp and spray bottle.

make_objects.py [FOLDER]    needs Debian's python3-numpy and python3-pil
"""
import io
import json
import math
import pathlib
import struct
import sys

import numpy
from PIL import Image, ImageDraw

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SIDES = 48  # of round things


class Obj:
    """A Wavefront OBJ mesh in metres with texture coordinates."""

    def __init__(self, texture):
        self.texture = texture
        self.vertices, self.uvs, self.faces = [], [], []

    def vertex(self, position, uv):
        self.vertices.append(position)
        self.uvs.append(uv)
        return len(self.vertices)

    def write(self, file):
        material = file.with_suffix(".mtl")
        material.write_text(f"newmtl print\nKd 1 1 1\nmap_Kd {self.texture}\n")
        lines = [f"mtllib {material.name}"]
        lines += ["v %.5f %.5f %.5f" % tuple(v) for v in self.vertices]
        lines += ["vt %.4f %.4f" % tuple(uv) for uv in self.uvs]
        lines += ["usemtl print"]
        lines += ["f " + " ".join(f"{i}/{i}" for i in face) for face in self.faces]
        file.write_text("\n".join(lines) + "\n")


def extrude(obj, loops, bottom, top, uv_of):
    """Adds the solid between z = bottom and top of a strip between two loops of equal length."""
    outer, inner = loops
    count = len(outer)
    index = {}
    for level, z in enumerate((bottom, top)):
        for loop, points in enumerate((outer, inner)):
            for i, (x, y) in enumerate(points):
                index[level, loop, i] = obj.vertex((x, y, z), uv_of(x, y))
    for i in range(count):
        j = (i + 1) % count
        obj.faces += [(index[1, 0, i], index[1, 0, j], index[1, 1, j]),
                      (index[1, 0, i], index[1, 1, j], index[1, 1, i]),
                      (index[0, 0, j], index[0, 0, i], index[0, 1, i]),
                      (index[0, 0, j], index[0, 1, i], index[0, 1, j]),
                      (index[0, 0, i], index[0, 0, j], index[1, 0, j]),
                      (index[0, 0, i], index[1, 0, j], index[1, 0, i]),
                      (index[0, 1, j], index[0, 1, i], index[1, 1, i]),
                      (index[0, 1, j], index[1, 1, i], index[1, 1, j])]


def fill(obj, outline, bottom, top, uv_of):
    """Adds the solid between z = bottom and top of a convex outline, counter-clockwise."""
    low = [obj.vertex((x, y, bottom), uv_of(x, y)) for x, y in outline]
    high = [obj.vertex((x, y, top), uv_of(x, y)) for x, y in outline]
    for i in range(1, len(outline) - 1):
        obj.faces += [(high[0], high[i], high[i + 1]), (low[0], low[i + 1], low[i])]
    for i in range(len(outline)):
        j = (i + 1) % len(outline)
        obj.faces += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]


def circle(x, y, radius_x, radius_y):
    turns = [2 * math.pi * i / SIDES for i in range(SIDES)]
    return [(x + radius_x * math.cos(t), y + radius_y * math.sin(t)) for t in turns]


def scissor_blade(side):
    """A blade with its ring; side -1 is the mirror image in x, below the other one."""
    obj = Obj("scissors.png")
    bottom, top = (0, 0.003) if side > 0 else (-0.003, 0)

    def uv_of(x, y):  # the picture shows x from -50 to 50 mm, y from -100 to 100 mm
        u = side * x / 0.1
        return (0.25 + u / 2 if side > 0 else 0.75 + u / 2), 0.5 + y / 0.2

    def placed(points):
        return [(side * x, y) for x, y in (points if side > 0 else points[::-1])]

    fill(obj, placed([(-0.001, 0.09), (-0.009, 0.012), (-0.009, -0.012), (0.009, -0.012),
                      (0.010, 0.012)]), bottom, top, uv_of)
    fill(obj, placed([(-0.008, -0.011), (0.007, -0.040), (0.018, -0.036), (0.008, -0.011)]),
         bottom, top, uv_of)
    extrude(obj, (placed(circle(0.019, -0.064, 0.019, 0.028)),
                  placed(circle(0.019, -0.064, 0.012, 0.021))), bottom - 0.002, top + 0.002, uv_of)
    return obj


def spray_bottle():
    """A surface of revolution about y: body, shoulder, neck and head; 185 mm high."""
    profile = [(0, 0), (22, 0), (25, 3), (25.5, 8), (25.5, 95), (24.5, 110), (20, 124), (13, 134),
               (10.5, 139), (10.5, 147), (14, 148), (15, 152), (15, 172), (12, 182), (7, 185),
               (0, 185)]
    profile = [(r / 1000, y / 1000 - 0.055) for r, y in profile]
    along = [0]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        along.append(along[-1] + math.hypot(r1 - r0, y1 - y0))
    obj = Obj("spray_bottle.png")
    rings = []
    for (radius, y), length in zip(profile, along):
        ring = []
        for i in range(SIDES + 1):
            turn = -2 * math.pi * i / SIDES
            ring.append(obj.vertex((radius * math.cos(turn), y, radius * math.sin(turn)),
                                   (i / SIDES, length / along[-1])))
        rings.append(ring)
    for low, high in zip(rings, rings[1:]):
        for i in range(SIDES):
            if low is not rings[0]:
                obj.faces.append((low[i], low[i + 1], high[i + 1]))
            if high is not rings[-1]:
                obj.faces.append((low[i], high[i + 1], high[i]))
    return obj


def bar(start, end, width, depth, bone, uv):
    """Returns corners, texture coordinates, triangles and the bone of a bar along y."""
    corners = [(sx * width / 2, y, sz * depth / 2)
               for y in (start, end) for sx, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    left, bottom, right, top = uv
    quads = [((k, 4 + k, 4 + (k + 1) % 4, (k + 1) % 4), k / 4, (k + 1) / 4) for k in range(4)]
    quads += [((0, 1, 2, 3), 0, 1), ((4, 7, 6, 5), 0, 1)]
    points, coordinates, triangles = [], [], []
    for quad, u0, u1 in quads:
        triangles += [len(points) + i for i in (0, 1, 2, 0, 2, 3)]
        points += [corners[i] for i in quad]
        coordinates += [(left + (right - left) * u, bottom + (top - bottom) * v)
                        for u, v in ((u0, 1), (u0, 0), (u1, 0), (u1, 1))]
    return points, coordinates, triangles, bone


def lamp(texture):
    """A desk lamp as GLB: bones `stand`, `lower_arm`, `upper_arm` and `head`, one above the other."""
    bones = [("stand", 0.0), ("lower_arm", 0.02), ("upper_arm", 0.13), ("head", 0.12)]
    parts = [bar(-0.01, 0.02, 0.09, 0.09, 0, (0, 0, 0.25, 1)),
             bar(0.02, 0.16, 0.035, 0.03, 1, (0.25, 0, 0.5, 1)),
             bar(0.15, 0.28, 0.03, 0.035, 2, (0.5, 0, 0.75, 1)),
             bar(0.26, 0.33, 0.075, 0.06, 3, (0.75, 0, 1, 1))]
    heights = numpy.cumsum([height for _, height in bones])
    points, coordinates, triangles, joints = [], [], [], []
    for its_points, its_coordinates, its_triangles, bone in parts:
        triangles += [len(points) + i for i in its_triangles]
        points += its_points
        coordinates += its_coordinates
        joints += [(bone, 0, 0, 0)] * len(its_points)
    inverse = []
    for height in heights:
        matrix = numpy.eye(4)
        matrix[1, 3] = -height
        inverse.append(matrix.T.reshape(16))
    binary, views, accessors = b"", [], []

    def add_view(data):
        nonlocal binary
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + b"\0" * (-len(data) % 4)
        return len(views) - 1

    def add(array, component, kind):
        view = add_view(array.tobytes())
        accessors.append({"bufferView": view, "componentType": component, "type": kind,
                          "count": len(array)})
        if kind == "VEC3":
            accessors[-1].update(min=array.min(0).tolist(), max=array.max(0).tolist())
        return len(accessors) - 1

    as_float = lambda rows: numpy.array(rows, dtype="<f4")
    attributes = {"POSITION": add(as_float(points), 5126, "VEC3"),
                  "TEXCOORD_0": add(as_float(coordinates), 5126, "VEC2"),
                  "JOINTS_0": add(numpy.array(joints, dtype="u1"), 5121, "VEC4"),
                  "WEIGHTS_0": add(as_float([(1, 0, 0, 0)] * len(points)), 5126, "VEC4")}
    indices = add(numpy.array(triangles, dtype="<u2"), 5123, "SCALAR")
    matrices = add(as_float(inverse), 5126, "MAT4")
    png = io.BytesIO()
    texture.picture().save(png, "PNG", optimize=True)
    nodes = [{"name": name, "translation": [0, height, 0], "children": [i + 1]}
             for i, (name, height) in enumerate(bones)]
    del nodes[-1]["children"]
    nodes.append({"name": "lamp", "mesh": 0, "skin": 0})
    content = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, len(bones)]}],
        "nodes": nodes, "skins": [{"joints": list(range(len(bones))), "skeleton": 0,
                                   "inverseBindMatrices": matrices}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": add_view(png.getvalue()), "mimeType": "image/png"}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]},
        separators=(",", ":")).encode()
    content += b" " * (-len(content) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(content) + len(binary)) +
            struct.pack("<I4s", len(content), b"JSON") + content +
            struct.pack("<I4s", len(binary), b"BIN\0") + binary)


class Painter:
    """Paints at twice the size, so that edges become smooth."""

    def __init__(self, width, height, seed):
        self.size = (width, height)
        self.image = Image.new("RGB", (2 * width, 2 * height))
        self.draw = ImageDraw.Draw(self.image)
        self.random = numpy.random.default_rng(seed)

    def uniform(self, low, high):
        return float(self.random.uniform(low, high))

    def rectangle(self, left, top, right, bottom, color):
        self.draw.rectangle([2 * left, 2 * top, 2 * right - 1, 2 * bottom - 1], fill=color)

    def blobs(self, area, colors, sizes, density=1.0):
        """Fills an area with round shapes, large ones below small ones."""
        left, top, right, bottom = area
        for size in sizes:
            count = int(density * (right - left) * (bottom - top) / (size * size) / 1.6)
            for _ in range(count):
                x, y = self.uniform(left, right), self.uniform(top, bottom)
                a, b = self.uniform(0.3, 0.6) * size, self.uniform(0.2, 0.6) * size
                box = [2 * max(x - a, left), 2 * max(y - b, top), 2 * min(x + a, right - 1),
                       2 * min(y + b, bottom - 1)]
                self.draw.ellipse(box, fill=colors[int(self.random.integers(len(colors)))])

    def strokes(self, area, color, count, length, thickness, slope=0.0):
        left, top, right, bottom = area
        for _ in range(count):
            x, y = self.uniform(left, right), self.uniform(top, bottom)
            dx = self.uniform(0.4, 1) * length
            dy = self.uniform(-slope, slope) * dx
            line = [2 * x, 2 * y, 2 * min(x + dx, right - 1), 2 * min(max(y + dy, top), bottom - 1)]
            self.draw.line(line, fill=color, width=int(2 * thickness))

    def grain(self, area, colors, count, thickness):
        """Wood: wavy lines from the top to the bottom."""
        left, top, right, bottom = area
        for _ in range(count):
            x, sway = self.uniform(left, right), self.uniform(2, 9)
            phase, period = self.uniform(0, 6), self.uniform(60, 200)
            points = [(2 * (x + sway * math.sin(phase + y / period)), 2 * y)
                      for y in range(top, bottom, 4)]
            self.draw.line(points, fill=colors[int(self.random.integers(len(colors)))],
                           width=int(2 * self.uniform(0.3, 1) * thickness))

    def picture(self, colors=64):
        small = self.image.resize(self.size, Image.LANCZOS)
        return small.quantize(colors, dither=Image.Dither.NONE)

    def save(self, file):
        self.picture().save(file, optimize=True)


def paint_scissors():
    painter = Painter(512, 512, 1)
    for left, vivid in ((0, [(214, 72, 30), (240, 120, 40), (170, 40, 20), (250, 190, 90)]),
                        (256, [(30, 90, 190), (60, 140, 220), (20, 50, 120), (150, 200, 240)])):
        steel = [(190, 195, 200), (150, 156, 165), (110, 116, 125), (215, 218, 222), (85, 90, 98)]
        area = (left, 0, left + 256, 512)
        painter.rectangle(*area, steel[0])
        painter.blobs((left, 0, left + 256, 296), steel, (30, 16, 8, 5))
        painter.strokes((left, 0, left + 256, 290), (60, 62, 70), 120, 14, 1.2, 0.8)
        painter.rectangle(left, 296, left + 256, 512, vivid[0])
        painter.blobs((left, 296, left + 256, 512), vivid, (36, 20, 10, 6))
    return painter


def paint_wood(seed, light, dark):
    painter = Painter(384, 384, seed)
    whole = (0, 0, 384, 384)
    middle = tuple((a + b) // 2 for a, b in zip(light, dark))
    painter.rectangle(*whole, light)
    painter.grain(whole, [middle, dark, light], 160, 5)
    painter.blobs(whole, [dark, middle], (22, 12), 0.06)
    painter.grain(whole, [dark], 40, 1.5)
    return painter


def paint_front():
    """The drawer's front: wood with a sheet of stickers."""
    painter = paint_wood(5, (222, 190, 140), (150, 105, 60))
    stickers = [(200, 50, 60), (50, 120, 190), (240, 210, 70), (70, 160, 90), (240, 240, 235),
                (40, 40, 50)]
    painter.blobs((0, 0, 384, 384), stickers, (60, 34), 0.22)
    painter.strokes((0, 0, 384, 384), (50, 40, 35), 70, 26, 2, 0.2)
    return painter


def paint_keyboard():
    painter = Painter(560, 380, 7)
    painter.rectangle(0, 0, 560, 380, (176, 180, 186))
    legend = [(240, 240, 240), (250, 200, 80), (120, 200, 250)]
    for row in range(6):
        left = 16 + 7 * (row % 3)
        while left < 530:
            width = 34 if row < 5 else int(painter.uniform(30, 110))
            right = min(left + width, 546)
            painter.rectangle(left, 14 + 36 * row, right, 44 + 36 * row, (42, 44, 50))
            area = (left + 5, 18 + 36 * row, right - 4, 40 + 36 * row)
            painter.strokes(area, legend[row % 3], 3, 14, 2.5, 1.5)
            left = right + 4
    painter.rectangle(190, 246, 370, 366, (150, 154, 160))
    stickers = [(200, 60, 70), (40, 120, 180), (240, 220, 90), (80, 170, 110), (30, 30, 40)]
    painter.blobs((8, 246, 182, 366), stickers, (44, 24, 12), 0.6)
    painter.blobs((378, 246, 552, 366), stickers, (44, 24, 12), 0.6)
    return painter


def paint_screen():
    """A desktop with windows, and its picture."""
    painter = Painter(560, 380, 9)
    painter.rectangle(0, 0, 560, 380, (24, 24, 28))
    painter.rectangle(14, 14, 546, 366, (60, 110, 150))
    hills = [(40, 90, 120), (70, 140, 110), (220, 170, 110), (90, 160, 200), (180, 90, 80)]
    painter.blobs((14, 14, 546, 366), hills, (120, 60, 30), 1)
    for left, top, right, bottom in ((40, 40, 260, 220), (300, 120, 520, 340)):
        painter.rectangle(left, top, right, bottom, (245, 245, 240))
        painter.rectangle(left, top, right, top + 18, (70, 70, 90))
        for row in range(top + 28, bottom - 10, 12):
            painter.strokes((left + 8, row, right - 30, row + 2), (60, 60, 70), 5, 60, 4)
    return painter


def paint_lid():
    painter = Painter(384, 256, 11)
    painter.rectangle(0, 0, 384, 256, (90, 94, 104))
    stickers = [(200, 60, 70), (40, 120, 180), (240, 220, 90), (80, 170, 110), (230, 230, 230),
                (50, 52, 60), (130, 134, 144)]
    painter.blobs((0, 0, 384, 256), stickers, (60, 34, 18, 9), 0.8)
    return painter


def paint_bottle():
    """From the left around the bottle, from the bottom (below) to its head (above)."""
    painter = Painter(640, 640, 13)
    blue = [(30, 90, 170), (50, 120, 200), (20, 60, 120), (90, 160, 220)]
    painter.rectangle(0, 0, 640, 640, (225, 232, 238))
    painter.blobs((0, 0, 640, 210), blue, (50, 26, 13), 0.8)       # head
    painter.blobs((0, 210, 640, 330), [(150, 190, 220), (190, 215, 232)], (44, 22, 11), 0.8)
    painter.blobs((0, 560, 640, 640), [(150, 190, 220), (190, 215, 232)], (44, 22, 11), 0.8)
    label = (0, 330, 640, 560)
    painter.rectangle(*label, (245, 205, 60))
    painter.blobs(label, [(230, 120, 40), (250, 230, 140), (200, 60, 50), (60, 140, 90)],
                  (80, 44, 24, 12), 0.5)
    painter.strokes((0, 336, 640, 550), (40, 40, 60), 150, 40, 4, 0.1)
    painter.strokes((0, 336, 640, 550), (250, 250, 250), 60, 60, 6, 0.1)
    return painter


def paint_lamp():
    """A strip per part, from the left: stand, lower and upper arm, head."""
    painter = Painter(400, 400, 17)
    for i, colors in enumerate((
            [(60, 62, 70), (100, 104, 112), (220, 180, 60)], [(190, 60, 50), (240, 130, 90),
             (120, 30, 30)], [(40, 110, 150), (120, 180, 210), (20, 60, 90)],
            [(235, 200, 80), (250, 235, 170), (170, 120, 40)])):
        area = (100 * i, 0, 100 * i + 100, 400)
        painter.rectangle(*area, colors[0])
        painter.blobs(area, colors, (40, 22, 12, 7), 0.9)
    return painter


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else SOURCE / "configs/objects"
    folder.mkdir(parents=True, exist_ok=True)
    scissor_blade(1).write(folder / "blade_right.obj")
    scissor_blade(-1).write(folder / "blade_left.obj")
    spray_bottle().write(folder / "spray_bottle.obj")
    paint_scissors().save(folder / "scissors.png")
    paint_wood(3, (196, 150, 96), (120, 78, 40)).save(folder / "wood.png")
    paint_front().save(folder / "drawer_front.png")
    paint_keyboard().save(folder / "keyboard.png")
    paint_screen().save(folder / "screen.png")
    paint_lid().save(folder / "lid.png")
    (folder / "lamp.glb").write_bytes(lamp(paint_lamp()))
    paint_bottle().save(folder / "spray_bottle.png")


if __name__ == "__main__":
    main()
