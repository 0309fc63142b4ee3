#!/usr/bin/env python3
"""Checks the documentation: check_links.py [ROOT].

Fails if a relative link or its anchor does not resolve, if a file in docs/results is linked from no page,
if README.md has numbers that no page of docs/results has, if docs/ or README.md have too many words, or if their
sentences are too long. Prints word counts and the
median and 90th percentile of sentence length.
"""
import re
import sys
from pathlib import Path

MAX_WORDS = 18000  # in docs/, without generated pages; a word has a letter, so numbers of tables do not count
MAX_README_WORDS = 700
MAX_P90 = 24  # words of a sentence
GENERATED = "docs/reference/plugins/"

FENCE = re.compile(r"^( *)(```|~~~).*?^\1\2 *$", re.M | re.S)
COMMENT = re.compile(r"<!--.*?-->", re.S)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
LIST_ITEM = re.compile(r"^\s*([-*]|\d+\.)\s+")


def slug(heading):
    """Anchor that GitHub gives a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors(text):
    seen, result = {}, set()
    for heading in re.findall(r"^#+ +(.*?) *#*$", FENCE.sub("", text), re.M):
        name = slug(heading)
        count = seen.get(name, 0)
        seen[name] = count + 1
        result.add(name if count == 0 else f"{name}-{count}")
    return result


def paragraphs(text):
    """Prose, one string per paragraph or list item: no code, tables or headings."""
    text = COMMENT.sub("", FENCE.sub("\n", text))
    block = []
    for line in text.split("\n") + [""]:
        is_prose = line.strip() and not line.startswith(("    ", "|", "#", ">"))
        starts_item = LIST_ITEM.match(line)
        if block and (not is_prose or starts_item):
            yield " ".join(block)
            block = []
        if is_prose:
            block.append(LIST_ITEM.sub("", line).strip())


def sentences(text):
    for paragraph in paragraphs(text):
        paragraph = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", paragraph)
        for sentence in re.split(r"(?<=[.!?])[)`*\"]*\s+(?=[A-Z`*\"(\[0-9])", paragraph):
            words = [w for w in sentence.split() if re.search(r"\w", w)]
            if words:
                yield len(words), sentence


def unknown_results(texts, root):
    """Yields rows with measured numbers in README's tables that are no rows of docs/results: a number has one home."""
    home = {line for page, text in texts.items() if page.parent == root / "docs/results" for line in text.split("\n")}
    for line in texts[root / "README.md"].split("\n"):
        if line.startswith("|") and re.search(r"\d (mm|ms|s|fps|%) ", line) and line not in home:
            yield f"README.md: no page of docs/results has the row {line}"


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    pages = sorted(root.glob("docs/**/*.md")) + [root / "README.md"]
    others = [root / "CONTRIBUTING.md", root / "CHANGELOG.md", *sorted(root.glob("examples/**/*.md"))]
    texts = {page: page.read_text() for page in pages + others}
    errors, linked = [], set()

    for page, text in texts.items():
        for target in LINK.findall(FENCE.sub("", text)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = (page.parent / name).resolve() if name else page
            linked.add(file)
            where = f"{page.relative_to(root)}: {target}"
            if not file.exists():
                errors.append(f"{where}: there is no such file")
            elif anchor and file.suffix == ".md":
                if anchor not in anchors(file.read_text()):
                    errors.append(f"{where}: there is no such heading")
    for file in sorted((root / "docs/results").glob("*")):
        if file.suffix != ".md" and file.resolve() not in linked:
            errors.append(f"{file.relative_to(root)}: no page shows it")

    errors += unknown_results(texts, root)

    total, lengths = 0, []
    for page in pages:
        name = str(page.relative_to(root))
        if name.startswith(GENERATED):
            continue
        words = sum(1 for w in COMMENT.sub("", texts[page]).split() if re.search(r"[^\W\d]", w))
        of_page = sorted(sentences(texts[page]))
        counts = [n for n, _ in of_page] or [0]
        print(f"{words:6d} words  p50 {counts[len(counts) // 2]:3d}  p90 {counts[len(counts) * 9 // 10]:3d}  {name}")
        lengths += counts
        if name == "README.md":
            if words > MAX_README_WORDS:
                errors.append(f"README.md: {words} words, more than {MAX_README_WORDS}")
        else:
            total += words
        if "--long" in sys.argv:
            for n, sentence in of_page:
                if n > MAX_P90:
                    print(f"        {n}: {sentence}")
    lengths.sort()
    p50, p90 = lengths[len(lengths) // 2], lengths[len(lengths) * 9 // 10]
    print(f"{total:6d} words in docs/; sentences: {len(lengths)}, p50 {p50}, p90 {p90} words")
    if total > MAX_WORDS:
        errors.append(f"docs/: {total} words, more than {MAX_WORDS}")
    if p90 > MAX_P90:
        errors.append(f"90 % of the sentences have up to {p90} words; the limit is {MAX_P90}")
    for error in errors:
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
