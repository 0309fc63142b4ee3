"""Reads C++ headers by Doxygen."""
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

CONFIG = """
INPUT = {include}/hypotrack
STRIP_FROM_PATH = {include}
FILE_PATTERNS = *.hpp *.cuh
EXTENSION_MAPPING = cuh=C++
RECURSIVE = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
HAVE_DOT = NO
INCLUDE_GRAPH = NO
INCLUDED_BY_GRAPH = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = HYPOTRACK_API= __device__= __global__= __forceinline__=inline __host__=
EXTRACT_ALL = YES
AUTOLINK_SUPPORT = YES
QUIET = YES
WARNINGS = NO
WARN_IF_DOC_ERROR = NO
OUTPUT_DIRECTORY = {out}
"""


def mark_up(text):
    """Returns a header whose comments Doxygen reads as they are written: further indented lines as code, `<` and `#` as text."""
    out, in_code, in_list = [], False, False
    for line in text.split("\n"):
        found = re.match(r"\s*/// ?(\s*)(.*)$", line)
        indented = bool(found and len(found[1]) >= 2 and found[2] and not in_list)
        if indented != in_code and not (in_code and found and not found[2]):
            out.append("/// @verbatim" if indented else "/// @endverbatim")
            in_code = indented
        if found:
            in_list = found[2].startswith("- ") or (in_list and len(found[1]) >= 2)
            comment = re.search(r"///<?", line).end()
            if not in_code:
                line = line[:comment] + escape(line[comment:])
        else:
            in_list = False
            line = re.sub(r"(?<=///<)(.*)", lambda m: escape(m[1]), line)
        out.append(line)
    return "\n".join(out)


def escape(comment):
    return "".join(p if p.startswith("`") else re.sub(r"([<#@])", r"\\\1", p) for p in re.split(r"(`[^`]*`)", comment))


def read_xml(headers, scratch):
    """Runs Doxygen on a copy of the headers and returns its compounds by id."""
    include = Path(scratch, "include")
    for file in headers.rglob("hypotrack/**/*.[hc][pu]*"):
        copy = include / file.relative_to(headers)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(mark_up(file.read_text()))
    config = CONFIG.format(include=include, out=scratch)
    subprocess.run(["doxygen", "-"], input=config, text=True, check=True, stdout=subprocess.DEVNULL)
    compounds = {}
    for file in Path(scratch, "xml").glob("*.xml"):
        if file.name not in ("index.xml", "Doxyfile.xml"):
            for compound in ElementTree.parse(file).getroot().iter("compounddef"):
                compounds[compound.get("id")] = compound
    return compounds
