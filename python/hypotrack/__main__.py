"""Runs the program: `python3 -m hypotrack run scene.yaml`."""

import os
import pathlib
import shutil
import sys


def main():
    """Becomes the program of this package, or that on PATH where the package has none."""
    own = pathlib.Path(__file__).parent / "bin/hypotrack"
    program = own if own.exists() else shutil.which("hypotrack")
    if not program:
        sys.exit("the program hypotrack is not on PATH; install the package hypotrack")
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
