"""Turns pages of the repository into pages of the site: dialect of Markdown, and links."""
import os
import re
from pathlib import Path

COMMENT = re.compile(r"<!--.*?-->", re.S)
FENCE = re.compile(r"(`{3,}|~{3,})\s*(.*)$")
ITEM = re.compile(r"([-*+]|\d+\.)(\s+)")
LINK = re.compile(r"(?<=\])\(([^)\s]+)\)")
CODE = re.compile(r"(`+)(.+?)\1", re.S)
LANGUAGES = {"sh": "bash", "text": "text", "cmake": "cmake", "": "text"}
SUFFIXES = {".yaml": "yaml", ".py": "python", ".cpp": "cpp", ".hpp": "cpp", ".cuh": "cpp", ".sh": "bash",
            ".sbatch": "bash"}
PAGES = {"README.md": "index.md", "docs/index.md": "overview.md", "CONTRIBUTING.md": "contributing.md",
         "CHANGELOG.md": "changelog.md"}


def site_path(path):
    """Returns where a file of the repository stands in the site's sources; other files stand below source/."""
    if path in PAGES:
        return PAGES[path]
    if path.startswith("docs/"):
        return path[len("docs/"):]
    return f"source/{path}"


class Links:
    """Rewrites links between files of the repository, and remembers the files outside docs/ that they name."""

    def __init__(self, root):
        self.root = Path(root)
        self.sources = set()

    def target(self, link, page):
        """Returns a link of a page, from its place in the site."""
        if re.match(r"[a-z]+:|#", link):
            return link
        name, _, anchor = link.partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(page), name))
        if not (self.root / path).exists():
            raise SystemExit(f"{page}: the link {link} names no file; expected one of the repository")
        there = site_path(path)
        if there.startswith("source/"):
            self.sources.add(path)
            there = page_name(self.root / path, there)
        there = os.path.relpath(there, os.path.dirname(site_path(page)) or ".")
        return there + (f"#{anchor}" if anchor else "")

    def rewrite(self, text, page):
        return LINK.sub(lambda m: f"({self.target(m[1], page)})", text)


def fence_head(mark, info):
    """Returns the first line of a code block: `cpp file=a.cpp` becomes a title."""
    words = info.split()
    language = words[0] if words else ""
    title = next((w[len("file="):] for w in words[1:] if w.startswith("file=")), None)
    return f"{mark}{LANGUAGES.get(language, language)}" + (f' title="{title}"' if title else "")


class Dialect:
    """Converts GitHub's Markdown to Python-Markdown's: four spaces a level, blank lines before blocks."""

    def __init__(self):
        self.out, self.levels, self.fence = [], [], None

    def put(self, text):
        self.out.append("    " * len(self.levels) + text if text else "")

    def separate(self):
        if self.out and self.out[-1].strip():
            self.out.append("")

    def line(self, line):
        indent = len(line) - len(line.lstrip(" "))
        if self.fence:
            return self.in_fence(line)
        if not line.strip():
            return self.out.append("")
        item, fence = ITEM.match(line.lstrip()), FENCE.match(line.lstrip())
        lazy = self.out and self.out[-1].strip() and not item and not fence and not line.startswith(("#", "|"))
        was_in_list = bool(self.levels)
        while self.levels and indent < self.levels[-1] and not lazy:
            self.levels.pop()
        base = self.levels[-1] if self.levels else 0
        text = line[min(base, indent):]
        if fence:
            self.separate()
            self.fence = fence[1]
            self.put(fence_head(fence[1], fence[2]))
        elif item and indent - base < 4:
            if not was_in_list:
                self.separate()
            self.put(item[1].ljust(4) + text.lstrip()[item.end():])
            self.levels.append(indent + item.end())
        else:
            if text.startswith("|"):
                text = text.replace(" ± ", "\u00a0±\u00a0")  # numbers stay on one line
                if self.out and not self.out[-1].lstrip().startswith("|"):
                    self.separate()
            self.put(text)

    def in_fence(self, line):
        base = self.levels[-1] if self.levels else 0
        text = line[base:] if line[:base].strip() == "" else line.lstrip()
        self.put(text)
        if text.strip() == self.fence:
            self.fence = None


def convert(text, links=None, page=""):
    """Returns a page for the site. Code stays as it is; comments go."""
    dialect = Dialect()
    for line in COMMENT.sub("", text).split("\n"):
        in_code = dialect.fence
        dialect.line(line)
        if links and not in_code and not dialect.fence:
            dialect.out[-1] = rewrite_outside_code(dialect.out[-1], links, page)
    return re.sub(r"\n{3,}", "\n\n", "\n".join(dialect.out)).strip("\n") + "\n"


def rewrite_outside_code(line, links, page):
    parts, at = [], 0
    for code in CODE.finditer(line):
        parts += [links.rewrite(line[at:code.start()], page), code[0]]
        at = code.end()
    # A link's text may be code: [`name`](file). The link follows the code then.
    return "".join(parts) + links.rewrite(line[at:], page)


def is_text(file):
    """Tells whether the site shows a file as a page; it only copies others, such as meshes and pictures."""
    if file.suffix == ".obj" or file.stat().st_size > 200_000:
        return False
    try:
        file.read_text()
    except UnicodeDecodeError:
        return False
    return True


def page_name(file, name):
    if file.is_dir():
        return f"{name}/index.md"
    return name if file.suffix == ".md" or not is_text(file) else f"{name}.md"


def source_page(root, path):
    """Returns the page that shows a file or folder of the repository."""
    file = Path(root) / path
    if file.is_dir():
        rows = [f"- [{p.name}]({page_name(p, p.name)})" for p in children(file)]
        return f"# {path}/\n\n" + "\n".join(rows) + "\n"
    language = SUFFIXES.get(file.suffix, "cmake" if file.name == "CMakeLists.txt" else "text")
    text = file.read_text()
    mark = "`" * max(3, 1 + max((len(m) for m in re.findall(r"`{3,}", text)), default=0))
    return f"# {file.name}\n\n`{path}` ([file]({file.name}))\n\n{mark}{language}\n{text.rstrip()}\n{mark}\n"


def children(folder):
    return [p for p in sorted(folder.iterdir()) if not p.name.startswith((".", "__"))]
