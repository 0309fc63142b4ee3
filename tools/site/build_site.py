#!/usr/bin/env python3
"""Builds the site of the documentation: build_site.py ROOT BUILD_DIR OUT [--gallery FOLDER].

ROOT is the source tree, BUILD_DIR its build with the Python package, OUT the folder for the site. It makes Markdown pages
in a temporary folder and gives them to MkDocs; the gallery's pictures are made before (gallery.py).
"""
import argparse
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import cpp_pages
import gallery
import markdown_pages
import python_pages

HERE = Path(__file__).resolve().parent


def write(pages, name, text):
    file = pages / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def copy_docs(root, pages, links):
    """Copies the pages of docs/ and the root, and the other files of docs/."""
    files = [root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md", *sorted((root / "docs").rglob("*"))]
    for file in files:
        path = str(file.relative_to(root))
        if file.suffix == ".md":
            write(pages, markdown_pages.site_path(path), markdown_pages.convert(file.read_text(), links, path))
        elif file.is_file():
            copy(file, pages / markdown_pages.site_path(path))


def copy(file, to):
    to.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(file, to)


def copy_sources(root, pages, links):
    """Makes the pages of files outside docs/ to which pages link, and of what those link to."""
    done = set()
    while links.sources - done:
        path = sorted(links.sources - done)[0]
        done.add(path)
        file = root / path
        if file.is_dir():
            links.sources |= {str(p.relative_to(root)) for p in markdown_pages.children(file)}
            write(pages, f"source/{path}/index.md", markdown_pages.source_page(root, path))
        elif file.suffix == ".md":
            write(pages, f"source/{path}", markdown_pages.convert(file.read_text(), links, path))
        else:
            copy(file, pages / f"source/{path}")
            if markdown_pages.is_text(file):
                write(pages, f"source/{path}.md", markdown_pages.source_page(root, path))


def order(root, pages, api):
    """Returns MkDocs' `nav`: the order of docs/index.md, and the pages made here."""
    sections, section = {}, "Concepts"
    for line in (root / "docs/index.md").read_text().split("\n"):
        head = re.match(r"\*\*(.*)\*\*$", line)
        section = head[1] if head else section
        for link in re.findall(r"\]\(([^)#:]+)\)", line):
            sections.setdefault(section, []).append(markdown_pages.site_path(f"docs/{link}".replace("docs/../", "")))
    listed = {page for of_section in sections.values() for page in of_section}
    missing = {str(p.relative_to(root / "docs")) for p in (root / "docs").rglob("*.md")} - listed
    missing = sorted(m for m in missing if m != "index.md" and not m.startswith("reference/plugins/"))
    if missing:
        raise SystemExit(f"docs/index.md: there is no link to {', '.join(missing)}; expected one to each page")
    sections["How-to guides"].remove("contributing.md")
    sections["Reference"].remove("reference/plugins/index.md")
    plugins = sorted(str(p.relative_to(pages)) for p in (pages / "reference/plugins").glob("*_*.md"))
    kinds = {}
    for page in plugins:
        kind, name = Path(page).stem.split("_", 1)
        kinds.setdefault(f"{kind.capitalize()}s", []).append({name: page})
    sections["Reference"] += [
        {"Plugins": ["reference/plugins/index.md", *({kind: of_kind} for kind, of_kind in kinds.items())]},
        {"Python": "reference/python.md"},
        {"C++": ["reference/cpp/index.md", *api]}]
    nav = [{"Home": "index.md"}, *({name: of_section} for name, of_section in sections.items())]
    if (pages / "gallery.md").exists():
        nav.append({"Gallery": "gallery.md"})
    return nav + [{"Project": [{"All pages": "overview.md"}, {"Contribute": "contributing.md"}, {"Changelog": "changelog.md"}]}]


def build(root, build_dir, out, pictures, scratch):
    pages = scratch / "pages"
    links = markdown_pages.Links(root)
    copy_docs(root, pages, links)
    api = []
    for name, text in cpp_pages.pages(root / "core/include", scratch):
        write(pages, f"reference/cpp/{name}", text)
        if name != "index.md":
            api.append({name.removesuffix(".md"): f"reference/cpp/{name}"})
    stub = root / "python/hypotrack/__init__.pyi"
    write(pages, "reference/python.md", python_pages.page(build_dir / "python", stub))
    if pictures:
        write(pages, "gallery.md", markdown_pages.convert(gallery.page(root, pictures, pages), links, "docs/gallery.md"))
    copy_sources(root, pages, links)
    copy(HERE / "site.css", pages / "site.css")
    settings = scratch / "mkdocs.yml"
    settings.write_text(json.dumps({"INHERIT": str(HERE / "mkdocs.yml"), "docs_dir": str(pages),
                                    "site_dir": str(out), "nav": order(root, pages, api)}))
    done = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--clean", "--config-file", settings])
    if done.returncode != 0:
        raise SystemExit("MkDocs could not build the site: see its messages above")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=Path)
    parser.add_argument("build_dir", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--gallery", type=Path, help="folder of the gallery's pictures")
    args = parser.parse_args()
    if args.out.exists() and any(args.out.iterdir()) and not (args.out / "search/search_index.json").exists():
        raise SystemExit(f"{args.out} holds other files, which would go; expected a new folder or a former site")
    with tempfile.TemporaryDirectory() as scratch:
        build(args.root.resolve(), args.build_dir.resolve(), args.out.resolve(), args.gallery, Path(scratch))


if __name__ == "__main__":
    main()
