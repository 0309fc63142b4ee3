#!/usr/bin/env python3
"""Runs a tutorial in a new folder: what its hidden comment prepares, the files that it tells to write and its commands.

run_tutorial.py PAGE SOURCE_DIR BUILD_DIR. Exit code 77: a comment `needs: FOLDER` names a folder that is missing,
for example $HAND_DETECTOR. Commands find scenes to record in $RECORDINGS and the build in
$BUILD; $PREFIX is where they may install it.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import textwrap
from pathlib import Path

BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^\1```$|<!-- test\n(.*?)-->", re.M | re.S)
WRITE = re.compile(r"Write `([\w.]+)`")


def steps(page):
    """Yields a shell command, or a file's name and content, in the order of the page."""
    for found in BLOCK.finditer(page):
        indent, language, text, prepare = found.groups()
        if prepare is not None:
            yield prepare, None
        elif language == "sh":
            yield textwrap.dedent(text), None
        elif language in ("yaml", "python"):
            names = WRITE.findall(page[: found.start()].rsplit("```", 1)[-1])
            if names:
                yield textwrap.dedent(text), names[-1]


def main():
    page, source, build = (Path(a).resolve() for a in sys.argv[1:])
    data_home = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local/share")
    os.environ.update(
        # Debian's Python, which runs this, has Debian's packages
        PATH=f"{build / 'bin'}:{Path(sys.executable).parent}:{os.environ['PATH']}",
        HAND_DETECTOR=f"{data_home}/hypotrack/hand_detector",
        RECORDINGS=str(source / "tests/system/docs/recordings"),
        BUILD=str(build),
    )
    text = page.read_text()
    for needed in re.findall(r"^<!-- needs: (.*) -->$", text, re.M):
        if not os.path.exists(os.path.expandvars(needed)):
            print(f"{needed} is missing: the tutorial cannot be tried here")
            return 77
    commands = 0
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # a run may still end
        os.environ["PREFIX"] = str(Path(folder) / "prefix")
        os.symlink(source / "configs", Path(folder) / "configs")
        for content, name in steps(text):
            if name:
                (Path(folder) / name).write_text(content)
                continue
            commands += 1
            print(content, flush=True)
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", content], cwd=folder)
            if done.returncode != 0:
                print(f"{page.name}: a command ended with {done.returncode}")
                return 1
    if commands == 0:
        print(f"{page.name}: has no command")
        return 1
    return 0


def end_servers():
    """Ends what the commands started and left running."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    os.killpg(0, signal.SIGTERM)


if __name__ == "__main__":
    os.setpgrp()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended from outside"))
    try:
        code = main()
    finally:
        end_servers()
    sys.exit(code)
