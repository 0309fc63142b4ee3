#!/usr/bin/env python3
"""check_abi.py SOURCE BUILD COMPILER FLAGS [--update | --self-test]: fails if the binary interface of plugins and
programs changed and kAbiVersion did not.

interface/N.xml.xz beside this script is the interface of kAbiVersion N: `abidw` wrote what the public headers
define, as a small library shows it that mentions all their types, and interface/N.txt has the functions that
libhypotrack exports, with the types of their arguments. Both are compared with today's: abidiff finds other
members, sizes, orders of virtual functions and values of enumerations. What is new beside the old is no change.

FLAGS are the compiler's, for headers of others. --update writes the files of a new kAbiVersion, and removes
those of the last one. Exit code 77: another compiler or other libraries than those of the files, or no
libabigail.
"""

import contextlib
import io
import lzma
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "names"))
from exported_names import exported  # noqa: E402

CLASS = re.compile(r"(?:class|struct|enum class|enum) (?:HYPOTRACK_API |alignas\(\w+\) )?(\w+)"
                   r"(?: final)?(?: : [\w:, <>]+)? \{")
FORWARD = re.compile(r"^namespace \w+ \{\n(?:(?:class|struct) \w+;.*\n)+\}.*\n", re.M)
OTHERS = "[suppress_type]\n  name_regexp = ^(const )?(std|Eigen|cv|__gnu_cxx)::\n"


def public_headers(include):
    """Headers that programs include; `-inl` and foreach_target are for one source each."""
    return [header for header in sorted(include.rglob("*.hpp"))
            if not re.search(r"-inl\.hpp$|foreach_target", header.name)]


def public_types(header):
    """Yields the types that a header defines outside of others, with their namespaces."""
    namespaces, before = [], ""
    for line in FORWARD.sub("", header.read_text()).splitlines():
        if opened := re.match(r"(?:inline )?namespace (?:HYPOTRACK_EXPORTED )?([\w:]*) ?\{$", line):
            namespaces.append(opened[1])
        elif line.startswith("}  // namespace"):
            namespaces.pop()
        elif (found := CLASS.match(line)) and not before.startswith(("template", "concept")):
            yield "::".join([*namespaces, found[1]])
        before = line


def source_of(include):
    headers = public_headers(include)
    lines = [f'#include "{header.relative_to(include)}"' for header in headers]
    types = sorted({name for header in headers for name in public_types(header)})
    assert len(types) > 100, f"only {len(types)} types in {include}"
    lines += ["namespace abi {"]
    lines += [f"void mention(const {name}*) {{}}" for name in types]
    lines += ["const char* tag() { return hypotrack::kBuildTag; }", "}"]
    return "\n".join(lines) + "\n"


def run(*command, **options):
    done = subprocess.run(list(map(str, command)), text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    return done.returncode, done.stdout


def library_of_headers(include, compiler, flags, folder):
    (folder / "abi.cpp").write_text(source_of(include))
    code, said = run(compiler, "-std=c++20", "-O0", "-g",
                     "-femit-class-debug-always", "-fPIC", "-shared", "-w", "-I", include, *flags,
                     folder / "abi.cpp", "-o", folder / "abi.so")
    assert code == 0, said
    return folder / "abi.so"


def dump_of(library, include, folder):
    code, said = run("abidw", "--headers-dir", include, "--no-show-locs", "--no-comp-dir-path",
                     "--no-corpus-path", "--no-elf-needed", "--out-file", folder / "new.xml", library)
    assert code == 0, said
    return folder / "new.xml"


def tag_of(library):
    return re.search(rb"c\+\+ \w+, cxxabi [^\0]*", library.read_bytes())[0].decode()


def functions_of(build):
    names = {name for name in exported("nm", build / "lib/libhypotrack.so")
             if name.startswith("hypotrack::") and "internal::" not in name and "(" in name}
    assert len(names) > 100, f"libhypotrack exports only {len(names)} functions"
    return sorted(names)


def differences(kept, new, folder):
    """Returns what abidiff says about an interface, or nothing."""
    (folder / "others.txt").write_text(OTHERS)
    (folder / "old.xml").write_bytes(lzma.decompress(kept.read_bytes()))
    code, said = run("abidiff", "--suppressions", folder / "others.txt", "--no-added-syms", "--no-show-locs",
                     folder / "old.xml", new)
    assert code & 3 == 0, f"abidiff failed: {said}"
    return said if code else ""


def write(types, functions, new, lines):
    for file in types.parent.glob("*"):
        file.unlink()
    types.parent.mkdir(exist_ok=True)
    types.write_bytes(lzma.compress(new.read_bytes(), preset=9))
    functions.write_text("".join(f"{line}\n" for line in lines))


def check(include, build, compiler, flags, update, folder):
    """Compares the headers of a folder and the functions of a build with what is kept."""
    number = int(re.search(r"kAbiVersion = (\d+);", "".join(
        header.read_text() for header in public_headers(include)))[1])
    again = f"  {' '.join(sys.argv[:4])} '{flags}' --update"
    types, functions = (HERE / f"interface/{number}{end}" for end in (".xml.xz", ".txt"))
    if not types.exists() and not update:
        print(f"kAbiVersion is {number}, and there is no {types.name}. Write it:\n{again}")
        return 1
    library = library_of_headers(include, compiler, flags.split(), folder)
    new = dump_of(library, include, folder)
    lines = [tag_of(library), *functions_of(build)]
    if not types.exists():
        write(types, functions, new, lines)
        return 0
    tag, *kept = functions.read_text().splitlines()
    if tag != lines[0]:
        print(f"{types.name} was made with other libraries: '{tag}'. These: '{lines[0]}'")
        return 77
    said = differences(types, new, folder)
    said += "".join(f"- {name} is gone or has other arguments\n" for name in sorted(set(kept) - set(lines)))
    if not said:
        print(f"The binary interface is that of kAbiVersion {number}")
        return 0
    print(f"{said}The binary interface is no longer that of kAbiVersion {number}. Take the change back, or "
          f"raise kAbiVersion\nin hypotrack/plugin/plugin.hpp (a patch version may not) and then run\n{again}")
    return 1


def self_test(include, *arguments, folder):
    """Changes a struct and an interface, and expects both to be told."""
    shutil.copytree(include, folder / "include")
    for name, place, added in [("solution.hpp", "struct Solution {", "int added = 0;"),
                               ("source.hpp", "class HYPOTRACK_API Source : public PluginObject {",
                                "virtual int added() { return 0; }")]:
        header = next((folder / "include").rglob(name))
        text = header.read_text()
        assert place in text, f"{name} has no '{place}'"
        header.write_text(text.replace(place, f"{place}\n {added}"))
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        code = check(folder / "include", *arguments, None, folder)
    if code == 77:
        return code
    for part in ["'int added'", "hypotrack::Source::added()", "raise kAbiVersion"]:
        assert part in said.getvalue(), f"{part} is not in\n{said.getvalue()}"
    print("A changed struct and a changed interface are found")
    return 0


def main(source, build, compiler, flags, option=None):
    if not shutil.which("abidw"):
        print("libabigail is not installed (abigail-tools): the binary interface is not compared")
        return 77
    include, build = pathlib.Path(source) / "core/include", pathlib.Path(build)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if option == "--self-test":
            return self_test(include, build, compiler, flags, folder=folder)
        return check(include, build, compiler, flags, option == "--update", folder)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
