#!/usr/bin/env python3
"""defined_once.py CTAGS FOLDER...: fails if sources define a class, struct, union or enum twice.

Two libraries of one process may share the functions of two classes of one name: that which was
loaded first serves both. Within a library the linker keeps one of two inline functions and says
nothing.

No others can mean names of anonymous namespaces and of functions, so these do not count. A name
within the inline namespace `internal` counts as one beside it, because code that uses both is
ambiguous. Names of different plugins count, too: their libraries hide them, but tests link several
plugins together.
"""

import json
import pathlib
import subprocess
import sys
from collections import defaultdict

KINDS = {"class", "struct", "union", "enum"}
SCOPES_OF_NAMES = KINDS | {"namespace"}  # a function is none
SUFFIXES = {".hpp", ".cpp", ".cu", ".cuh"}


def is_source(file):
    # X_absent.cpp is compiled in place of other sources, where a package is not there.
    return file.suffix in SUFFIXES and not file.stem.endswith("_absent")


def tags(ctags, files):
    command = [ctags, "--output-format=json", "--language-force=C++", "--kinds-C++=cgnsu",
               "--fields=+neKZ", "--fields-C++=+{specialization}", "-D", "HYPOTRACK_API=",
               "-D", "HYPOTRACK_EXPORTED=", "-L", "-", "-o", "-"]
    run = subprocess.run(command, input="\n".join(map(str, files)), text=True, check=True,
                         stdout=subprocess.PIPE)
    return map(json.loads, run.stdout.splitlines())


def others_can_mean(tag):
    return (tag["kind"] in KINDS and "specialization" not in tag
            and tag.get("scopeKind", "namespace") in SCOPES_OF_NAMES
            and "__anon" not in tag.get("scope", "") + tag["name"])


def main(ctags, *folders):
    files = sorted(file for folder in folders for file in pathlib.Path(folder).rglob("*")
                   if is_source(file))
    places = defaultdict(list)
    for tag in filter(others_can_mean, tags(ctags, files)):
        path = [*tag.get("scope", "").split("::"), tag["name"]]
        name = "::".join(part for part in path if part not in ("", "internal"))
        places[name].append(f"{tag['path']}:{tag['line']}")
    if "hypotrack::Session" not in places:
        sys.exit(f"hypotrack::Session was not found among {len(places)} names: is ctags that of "
                 "universal-ctags, and are these the folders of hypotrack?")
    twice = {name: where for name, where in places.items() if len(where) > 1}
    for name, where in sorted(twice.items()):
        print(f"{name} is defined at {', '.join(sorted(where))}: rename one")
    if not twice:
        print(f"{len(places)} names are defined once")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
