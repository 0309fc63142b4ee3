#!/usr/bin/env python3
"""exported_names.py NM LIBRARY [LIST [--update]]: fails unless a library exports what a list has.

The list has the classes and functions that HYPOTRACK_API marks, a sorted line each. Internals,
which are in namespaces `internal`, are left out: programs and tests of the same build use them.
Without a list a library may export internals only. --update writes the list.

Only code counts that is compiled once, for the library. Whether a library exports what headers
define, such as functions of templates, depends on what the compiler inlines.
"""

import pathlib
import re
import subprocess
import sys

STRONG = set("TDBR")  # of nm: code and data that are no weak copies


def exported(nm, library):
    run = subprocess.run([nm, "--dynamic", "--defined-only", "--demangle", library], text=True,
                         check=True, stdout=subprocess.PIPE)
    for line in run.stdout.splitlines():
        kind, symbol = line.split(maxsplit=2)[1:]
        if kind in STRONG:
            yield symbol


def qualified_name(symbol):
    """Returns the class or the free function that a symbol belongs to."""
    symbol = re.sub(r"^(non-virtual thunk to|virtual thunk to|vtable for|VTT for|typeinfo for|"
                    r"typeinfo name for|guard variable for) ", "", symbol)
    scopes = []
    for scope in re.match(r"[\w:~]*", symbol)[0].split("::"):
        scopes.append(scope)
        if scope[:1].isupper():  # a class: only these begin with a capital letter
            break
    return "::".join(scopes) if scopes[0] else symbol


def main(nm, library, list_file=None, update=None):
    names = {qualified_name(symbol) for symbol in exported(nm, library)}
    internal = {name for name in names if re.match(r"hypotrack::(\w+::)*internal::", name)}
    if not internal:
        sys.exit(f"{library}: found no internals among {len(names)} exported names")
    found = names - internal
    if update:
        pathlib.Path(list_file).write_text("".join(f"{name}\n" for name in sorted(found)))
        return 0
    listed = set(pathlib.Path(list_file).read_text().split()) if list_file else set()
    for name in sorted(found - listed):
        print(f"+ {name} is exported and not listed")
    for name in sorted(listed - found):
        print(f"- {name} is listed and not exported")
    if found == listed:
        print(f"{len(found)} public names and {len(internal)} internal ones, as listed")
        return 0
    print("A public name is marked with HYPOTRACK_API in a header of core/include. Any other is "
          "hidden,\nor declared in a namespace `internal` (base/exported.hpp).")
    if list_file:
        print(f"If the change is meant:\n  {__file__} {nm} {library} {list_file} --update")
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
