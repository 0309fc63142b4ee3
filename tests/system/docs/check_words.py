#!/usr/bin/env python3
"""Finds sentences that readers have to read twice: check_words.py ROOT, or check_words.py --self-test.

Reads README.md, CONTRIBUTING.md, CHANGELOG.md and docs/, but not the pages made from plugins, and prints file, line
and finding. It knows the kinds that a pattern can tell; the order of words is for the writer.
"""
import re
import sys
from pathlib import Path

MAX_SENTENCE = 40  # words
GENERATED = "docs/reference/plugins/"
KINDS = [
    (r"\b(is|are|was|were) said\b", "passive 'said': name who reports it"),
    (r"\bthose (that|who|which)\b", "'those that': use a noun"),
    (r"\bthat which\b", "'that which': use a noun"),
    (r"\b[Ww]hat\b[^.;:|()]*?(?<!to )\b(does|do|did)\b(?! not)", "'what ... does': name it by a noun"),
    (r"\bThe same for\b", "'The same for': repeat the noun"),
    (r"\b(and|or|for) such as\b", "'such as' without a noun before it"),
    (r"(^|[.!?] )Say (?!\")", "'Say ...': name the change or the message"),
    (r"\bwhich\b[^.;:|,]*\bwhich\b|, which\b[^.;:|]*, which\b", "two 'which' in one sentence: write two sentences"),
]
BLOCK_START = re.compile(r"^\s*([-*]|\d+\.)\s+|^#|^\||^>")
SENTENCE_END = re.compile(r"(?<=[.!?])[)`*\"]*\s+(?=[A-Z`*\"(\[0-9])")


def blocks(text):
    """Yields (first line, lines) of each paragraph, list item and row of a table; no code, no comments."""
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    first, block, fence = 0, [], None
    for number, line in enumerate(text.split("\n") + [""], 1):
        mark = re.match(r"\s*(```|~~~)", line)
        if mark or fence:
            if mark and fence is None:
                fence = mark[1]
            elif mark and mark[1] == fence:
                fence = None
            line = ""
        if block and (not line.strip() or BLOCK_START.match(line)):
            yield first, block
            block = []
        if line.strip():
            if not block and line.startswith("    "):  # an equation
                continue
            if not block:
                first = number
            block.append(re.sub(r"^\s*([-*]|\d+\.)\s+", "", line).strip())
    if block:
        yield first, block


def findings(text):
    """Yields (line, finding) of a Markdown text."""
    for first, lines in blocks(text):
        starts = [0]  # of each line in the block's text
        for line in lines:
            starts.append(starts[-1] + len(line) + 1)
        whole = " ".join(lines)
        line_of = lambda at: first + sum(start <= at for start in starts) - 1
        plain = re.sub(r"`[^`]*`", lambda m: "x" * len(m[0]), whole)  # code is not prose
        for pattern, advice in KINDS:
            for found in re.finditer(pattern, plain):
                yield line_of(found.start()), f"{advice} ({whole[found.start():found.end()].strip()[:60]})"
        if whole.startswith("|"):
            continue
        at = 0
        for sentence in SENTENCE_END.split(whole):
            words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", sentence).split()
            count = sum(1 for w in words if re.search(r"\w", w))
            if count > MAX_SENTENCE:
                yield line_of(whole.find(sentence, at)), f"a sentence of {count} words; at most {MAX_SENTENCE}"
            at += len(sentence)


def self_test():
    """Returns what the patterns get wrong."""
    bad = ["A missing file is said.", "It drops those that\nfail.", "It shows what a study of two does.", "The same for two.",
           "Stages for lost frames, and such as begin at the start.", "- Say only what is known.",
           "It reads a file which names a folder which holds pictures.", "word " * 41 + "end."]
    good = ["It says what to do.", "It has the same for each.", "Keys such as `size` count.", "It says so.", "`are said` is code.", "It does what it promises.",
            "```\nthose that\n```", "<!-- those that -->", "word " * 30 + "end."]
    return [f"not found: {t[:60]!r}" for t in bad if not list(findings(t))] + \
           [f"found in good text: {t[:60]!r}: {list(findings(t))}" for t in good if list(findings(t))]


def main():
    if sys.argv[1:] == ["--self-test"]:
        errors = self_test()
    else:
        root = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
        pages = [root / n for n in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")] + sorted(root.glob("docs/**/*.md"))
        names = {str(p.relative_to(root)): p for p in pages}
        errors = [f"{name}:{line}: {what}" for name, page in names.items() if not name.startswith(GENERATED)
                  for line, what in findings(page.read_text())]
    for error in errors:
        print(error, file=sys.stderr)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
