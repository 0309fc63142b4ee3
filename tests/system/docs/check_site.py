#!/usr/bin/env python3
"""Builds the site and checks it: check_site.py SOURCE_DIR BUILD_DIR, or check_site.py --self-test.

Fails if a link or its anchor leads nowhere, if a page or style sheet loads anything from another address, if a page
cannot be reached from the first one, or if a page of docs/, a plugin or the class Tracker has no page. Exit code 77: a package of
scripts/packages-site.txt is missing.
"""
import re
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADING_RELS = {"stylesheet", "icon", "shortcut", "preload", "prefetch", "preconnect", "dns-prefetch", "modulepreload", "manifest"}


class Page(HTMLParser):
    """Collects a page's anchors, its links, and what a browser loads for it."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loads = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[k] for k in ("id", "name") if values.get(k)}
        rels = set((values.get("rel") or "").split())
        if tag == "link" and rels & LOADING_RELS or tag == "object":
            self.loads.append(values.get("href") or values.get("data") or "")
        elif tag in ("a", "area") and values.get("href"):
            self.links.append(values["href"])
        for key in ("src", "poster"):
            if values.get(key):
                self.loads.append(values[key])
        self.loads += [part.split()[0] for part in (values.get("srcset") or "").split(",") if part.strip()]
        if "mermaid" in (values.get("class") or "").split():
            self.loads.append("https://unpkg.com/mermaid")  # the theme would get it from there


def is_elsewhere(link):
    return bool(urlsplit(link).netloc) or link.startswith("//")


def check(site):
    pages = {file: Page(file.read_text()) for file in site.rglob("*.html")}
    errors, linked = [], {}
    for file, page in pages.items():
        name = file.relative_to(site)
        errors += [f"{name}: loads {load} from the network" for load in page.loads if is_elsewhere(load)]
        for link in page.links + [load for load in page.loads if not load.startswith("data:")]:
            parts = urlsplit(link)
            if parts.scheme or is_elsewhere(link):
                continue
            path = unquote(parts.path)
            base = site if path.startswith("/") or file.name == "404.html" else file.parent
            target = (base / path.lstrip("/")).resolve() if path else file
            target = target / "index.html" if target.is_dir() else target
            linked.setdefault(file, set()).add(target)
            if not target.exists():
                errors.append(f"{name}: {link}: there is no such file")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                errors.append(f"{name}: {link}: there is no such heading")
    for file in site.rglob("*.css"):
        for url in re.findall(r"url\(\s*[\"']?([^\"')]+)|@import\s+[\"']([^\"']+)", file.read_text()):
            if is_elsewhere("".join(url)) and not "".join(url).startswith("data:"):
                errors.append(f"{file.relative_to(site)}: loads {''.join(url)} from the network")
    reached, todo = set(), [site / "index.html"]
    while todo:
        file = todo.pop()
        if file not in reached:
            reached.add(file)
            todo += linked.get(file, ())
    errors += [f"{f.relative_to(site)}: no page leads to it" for f in pages if f not in reached and f.name != "404.html"]
    return pages, errors


def missing_pages(source, site):
    """Returns what a reader would miss."""
    expected = {p.relative_to(source / "docs").with_suffix(".html") for p in (source / "docs").rglob("*.md")}
    expected -= {Path("index.html")}
    expected |= {Path(p) for p in ("index.html", "overview.html", "contributing.html", "reference/cpp/api_tracker.hpp.html")}
    errors = [f"{page}: there is no such page" for page in sorted(expected) if not (site / page).exists()]
    for page, words in (("reference/python.html", "Finds the scene in two pictures"),
                        ("reference/cpp/api_tracker.hpp.html", "Finds the scene in the next frame"),
                        ("search/search_index.json", "Finds the scene in the next frame")):
        if words not in (site / page).read_text():
            errors.append(f"{page}: does not have '{words}'")
    return errors


def self_test():
    """Returns what the checks get wrong."""
    bad = {"nothing.html": "no such file", "#nowhere": "no such heading", "b.html#nowhere": "no such heading"}
    loads = ['<script src="https://a.b/c.js"></script>', '<link rel="stylesheet" href="//a.b/c.css">',
             '<img src="http://a.b/c.png">', '<pre class="mermaid"></pre>', '<video poster="https://a.b/c.png"></video>']
    cases = [(f'<a href="{link}">x</a>', error) for link, error in bad.items()] + [(load, "from the network") for load in loads]
    wrong = []
    for text, error in cases + [('<a href="https://a.b/">x</a><a href="b.html#there">x</a><link rel="canonical" href="https://a.b">', "")]:
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "index.html").write_text(text + '<a href="b.html">b</a>')
            Path(folder, "b.html").write_text('<p id="there">')
            errors = check(Path(folder))[1]
            if bool(errors) != bool(error) or error not in "".join(errors):
                wrong.append(f"{text}: found {errors}, expected '{error}'")
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "index.html").write_text("")
        Path(folder, "alone.html").write_text("")
        Path(folder, "a.css").write_text("p { background: url('https://a.b/c.png') }")
        if len(check(Path(folder))[1]) != 2:
            wrong.append("a page that nothing leads to, or a picture of a style sheet, is not found")
    return wrong


def main():
    if sys.argv[1:] == ["--self-test"]:
        errors = self_test()
    else:
        source, build = (Path(a).resolve() for a in sys.argv[1:])
        lists = (source / "scripts/packages-site.txt").read_text().split("\n")
        for package in [p for p in lists if p and not p.startswith("#")]:
            if "ok installed" not in subprocess.run(["dpkg-query", "-W", "-f", "${Status}", package], capture_output=True, text=True).stdout:
                print(f"skipped: the Debian package {package} is missing")
                return 77
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder, "site")
            subprocess.run([source / "scripts/site.sh", "--no-gallery", "--build", build, site], check=True)
            pages, errors = check(site)
            errors += missing_pages(source, site)
            print(f"{len(pages)} pages")
    for error in sorted(set(errors)):
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
