#!/usr/bin/env python3
"""no_hands.py ROOT: fails if core, apart from its program, has a word of hands in a file or in its name.

Core tracks any model: plugins/hands/ knows hands, and models describe them (Model::directions()).
scripts/count.py has the words, and counts the files.
"""
import pathlib
import sys


def main(root):
    sys.path.insert(0, str(root / "scripts"))
    from count import HANDS_IN_NAMES
    found = []
    for file in sorted((root / "core").rglob("*")):
        name = file.relative_to(root)
        if not file.is_file() or name.parts[1] == "app":
            continue
        if HANDS_IN_NAMES.search(str(name)):
            found.append(f"{name}: its name")
        for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
            if HANDS_IN_NAMES.search(line):
                found.append(f"{name}:{number}: {line.strip()}")
    if found:
        print("core knows hands; move this into plugins/hands/, or word it for any model:", *found, sep="\n",
              file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
