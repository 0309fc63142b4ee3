#!/usr/bin/env python3
"""Counts what makes hypotrack hard to read: count.py [ROOT] [--build DIR] [--json].

Prints a table of a checkout, of tracked files only, so that two commits can be compared: git worktree add DIR COMMIT.

  product        core/, plugins/, lab/ and python/: C++, CUDA, Python, scripts and pages; no tests, tools, lab/microbench, examples
  short files    C++ and CUDA files of the product with fewer than 25 lines, comments and blank lines included
  large folders  folders of the product with more than 25 tracked files of any kind, without those below them
  constants      constexpr and const statements of the tracker that declare names k..., and these names
  numbers        literals in the tracker's code other than 0, 1 and 2, in constants or not; no lists of more than 16
  keys           parameters that the tracker's visit() functions declare
  words of hands hand, finger, palm, thumb, wrist, or their plurals, as words of code or comments. "In names" also counts
                 parts of names (hand_proportions, kHand)
  tracker loop   scene_tracker.cpp and .hpp; its room is all of core/src/track*/loop, or these two while there is no such
                 folder. Flags are members of a truth value, number, count, time or status. They are loose outside of
                 model_track.hpp, which owns a phase and what it remembers
  words of docs  as wc -w counts them, without the generated pages of plugins
  camera model   files of the product that name the fisheye model: a stand-in for the files that a camera model touches

A frame's walk through the code has no row: which place is a stay is a judgement. So have files touched for a plugin kind
or a virtual function: compare the commits that add one. With --build there are also the symbols that libhypotrack.so
exports, and the resolved keys of the recommended tracker.
"""
import argparse
import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

PRODUCT = ("core/", "plugins/", "lab/", "python/")
NO_PRODUCT = ("lab/microbench/",)
CODE = (".cpp", ".hpp", ".cu", ".cuh", ".h")
PAGES = (".js", ".css", ".html", ".py", ".sh")
HANDS = re.compile(r"\b(?:hand|finger|palm|thumb|wrist)s?\b", re.I)
HANDS_IN_NAMES = re.compile(  # also as parts of snake_case, CamelCase and UPPER_CASE
    r"(?<![A-Za-z])(?:hand|finger|palm|thumb|wrist)s?(?![a-z])|(?:Hand|Finger|Palm|Thumb|Wrist)s?(?![a-z])"
    r"|(?<![A-Za-z])(?:HAND|FINGER|PALM|THUMB|WRIST)S?(?![A-Za-z])")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
NUMBER = re.compile(r"(?<![\w.])(?:0x[\da-fA-F]+|\d[\d']*\.?\d*(?:e[-+]?\d+)?|\.\d+)[fFuUlL]*(?![\w.])")
FLAG = re.compile(
    r"^\s*(?:std::)?(?:atomic<\w+>|bool|int|unsigned|float|double|size_t|u?int\d+_t|Eigen::Index|Status|Phase)\s+"
    r"(\w+(?:\s*=\s*[^;,(]*)?(?:,\s*\w+)*)\s*(?:=[^;]*)?;", re.M)


def plain(text):
    """Code without comments and strings."""
    return NOT_CODE.sub(lambda m: '""' if m[0][0] == '"' else " ", text)


def constants(text):
    """Counts constexpr and const statements that declare names k..., and these names."""
    text, found, statements = plain(text), set(), set()
    for start in re.finditer(r"\b(?:constexpr|const)\b", text):
        depth, at, begin, before = 0, start.end(), start.end(), len(found)
        while at < len(text):
            c = text[at]
            if depth == 0 and c in ";,)":
                name = re.match(r"[^={(]*?\b(k[A-Z]\w*)\s*(?:\[[^\]]*\])?\s*(?:=(?!=)|\{)", text[begin:at])
                if name:
                    found.add(begin + name.start(1))
                if c != ",":
                    break
                begin = at + 1
            depth += (c in "({[") - (c in ")}]")
            if depth < 0:
                break
            at += 1
        if len(found) > before:
            statements.add(at)
    return len(statements), len(found)


def numbers(text):
    """Literals other than 0, 1 and 2, without long lists."""
    text = plain(text)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    while True:
        shorter = re.sub(r"\{[^{};]*\}", lambda m: "" if len(NUMBER.findall(m[0])) > 16 else f"({m[0][1:-1]})", text)
        if shorter == text:
            break
        text = shorter
    return sum(not re.fullmatch(r"0*[012](?:\.0*)?[fFuUlL]*", n) for n in NUMBER.findall(text))


def flags(text):
    """Members that are flags, counts, times or statuses."""
    declared = FLAG.findall(re.sub(r"\{[^{}]*\breturn\b[^{}]*\}", ";", plain(text)))
    return sum(len(re.split(r",", names)) for names in declared)


def search_types(text):
    return set(re.findall(r"\b(?:class|struct|enum class)\s+(\w*Search\w*)\b(?![^\n]*;)", plain(text)))


def count(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], check=True, capture_output=True, text=True).stdout
    files = [f for f in listed.split("\0") if f and (root / f).is_file()]
    product = [f for f in files if f.startswith(PRODUCT) and not f.startswith(NO_PRODUCT)]
    texts = {f: (root / f).read_text(errors="replace") for f in product if f.endswith(CODE + PAGES)}
    code = {f: t for f, t in texts.items() if f.endswith(CODE)}
    lines = {f: t.count("\n") for f, t in texts.items()}
    track = [t for f, t in code.items() if re.match(r"core/src/track(ing)?/", f)]
    loop = [f for f in code if re.fullmatch(r"core/src/track(ing)?/(loop/)?scene_tracker\.[ch]pp", f)]
    room = [f for f in code if re.match(r"core/src/track(ing)?/loop/", f)] or loop
    tracks = [f for f in room if f.endswith("/model_track.hpp")]
    core = {f: t for f, t in code.items() if f.startswith("core/") and not f.startswith("core/app/")}
    headers = [f for f in code if f.startswith("core/include/hypotrack/")]
    docs = [f for f in files if f.startswith("docs/") and f.endswith(".md") and "reference/plugins/" not in f]
    folders = Counter(f.rpartition("/")[0] for f in product)

    def saying(pattern, prefix):
        return sum(bool(pattern.search(t)) for f, t in core.items() if f.startswith(prefix))

    return {
        "tracker loop, lines": sum(lines[f] for f in loop),
        "  its room": sum(lines[f] for f in room),
        "tracker loop, loose flags": sum(flags(code[f]) for f in loop if f.endswith(".hpp")),
        "  in its room": sum(flags(code[f]) for f in room if f.endswith(".hpp") and f not in tracks),
        "flags that a phase owns": sum(flags(code[f]) for f in tracks),
        "constants in tracking": sum(constants(t)[0] for t in track),
        "  their names": sum(constants(t)[1] for t in track),
        "numbers in tracking": sum(map(numbers, track)),
        "keys of tracking": sum(len(re.findall(r'\bv\(\s*"', t)) for t in track),
        "core files with words of hands": saying(HANDS, "core/"),
        "  core/src": saying(HANDS, "core/src/"),
        "  core/include": saying(HANDS, "core/include/"),
        "core files with words of hands, in names too": saying(HANDS_IN_NAMES, "core/"),
        "product files": len(texts),
        "short files": sum(lines[f] < 25 for f in code),
        "large folders": sum(n > 25 for n in folders.values()),
        "product lines": sum(lines.values()),
        "public headers in one folder, at most": max(Counter(f.rpartition("/")[0] for f in headers).values(), default=0),
        "types with Search in their name": len(set().union(*map(search_types, code.values()))),
        "lines of Checked*": sum(n for f, n in lines.items() if re.search(r"/checked_\w+\.[ch]pp$", f)),
        "files that name the fisheye model": sum("fisheye" in t.lower() for t in code.values()),
        "words of docs": sum(len((root / f).read_text().split()) for f in docs),
    }


def count_built(root, build):
    library = build / "lib/libhypotrack.so"
    symbols = subprocess.run(["nm", "-DC", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    scene = subprocess.run([build / "bin/hypotrack", "validate", root / "configs/scenes/demo.yaml", "--print"],
                           check=True, capture_output=True, text=True).stdout
    tracker = scene[scene.index("\nobjective:"):]
    return {"exported symbols": symbols.count("\n"),
            "resolved keys of recommended": len(re.findall(r"^ *(?:- )?\w+: \S", tracker, re.M))}


def self_test():
    cases = [
        (constants("constexpr double kA = 1, kB{2};\nconst int kC[] = {1, 2};  // constexpr int kD = 1;\nf(kE);"), (2, 3)),
        (constants("static constexpr const char* kName = \"kOther = 1\"; bool is(const T& t) { return t == kX; }"), (1, 1)),
        (numbers("x = 3 * y + 0 - 1.0 + 2.5f; a7 = 1e-3; // 9\n"), 3),
        (numbers("w{" + ",".join(["0.5"] * 17) + "}; int n = 4;"), 1),
        (flags("  bool a_ = false;\n  int b, c;\n  double run(int n);\n  bool ok() const { return a_; }\n"), 3),
        (len(HANDS.findall("a hand, kHand, handle, left_hand, Fingers")), 2),
        (len(HANDS_IN_NAMES.findall("a hand, kHand, handle, left_hand, Fingers")), 4),
        (len(HANDS_IN_NAMES.findall("two_thumbs_up, HandProportions, itsPalm, wristX, HANDS, K_FINGER, by hand")), 7),
        (HANDS_IN_NAMES.findall("handler, beforehand, Handles, HANDLE, shorthand, unhandy, palmtree, chandler"), []),
        (len(search_types("class LimbSearch;\nclass PoseSearch final {\nstruct Search {\n")), 2),
    ]
    return [f"case {i}: {found}; expected {expected}" for i, (found, expected) in enumerate(cases) if found != expected]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--build", type=Path, help="build tree of this checkout")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--self-test", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.self_test:
        errors = self_test()
        print("\n".join(errors), file=sys.stderr, end="")
        return 1 if errors else 0
    table = count(options.root.resolve())
    if options.build:
        table |= count_built(options.root.resolve(), options.build.resolve())
    if options.json:
        print(json.dumps(table, indent=2))
    else:
        print("\n".join(f"{value:8,d}  {name}" for name, value in table.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
