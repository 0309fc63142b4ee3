"""Makes the page of the Python package: signatures of its stubs, text of its docstrings."""
import ast
import html
import importlib
import re
import sys
from pathlib import Path

OVERLOAD = re.compile(r"^\d+\. \w+\(.*$", re.M)
SIGNATURE = re.compile(r"^\w+\(.*\) -> .*$|^\w+\(.*\)$")


def docs_of(member):
    """Returns the text of each overload of a pybind11 function, without the signatures."""
    text = (getattr(member, "__doc__", None) or "").strip()
    if "Overloaded function." in text:
        return [part.strip() for part in OVERLOAD.split(text)[1:]]
    lines = text.split("\n")
    return ["\n".join(lines[1:] if SIGNATURE.match(lines[0]) else lines).strip()]


def link_pages(text, to_docs):
    """Makes links of the names of pages in a docstring."""
    return re.sub(r"\bdocs/([\w/]+)\.md\b", rf'<a href="{to_docs}/\1.html">\g<0></a>', text)


def paragraphs(text):
    """Returns docstring text as HTML; `code` is code."""
    blocks = re.split(r"\n\s*\n", text)
    show = lambda t: link_pages(re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(t, quote=False)), "..")
    return "".join(f"<p>{show(' '.join(b.split()))}</p>" for b in blocks if b.strip())


def link_types(text, classes):
    return re.sub(r"\b[A-Z]\w+\b", lambda m: f'<a href="#{m[0].lower()}">{m[0]}</a>' if m[0] in classes else m[0], text)


def without_aliases(tree):
    """Returns a stub whose own names of types are what they stand for: `_Path` is `str | PathLike[str]`."""
    aliases = {n.targets[0].id: n.value for n in tree.body if isinstance(n, ast.Assign)}

    class Replace(ast.NodeTransformer):
        def visit_Name(self, node):
            value = aliases.get(node.id, node)
            return ast.Name("type") if isinstance(value, ast.Call) else value

        def visit_Attribute(self, node):  # np.float64
            return ast.Name(node.attr)

    return Replace().visit(Replace().visit(tree))


def declaration(node):
    """Returns the declaration of a stub, one parameter a line where it is long."""
    if isinstance(node, ast.AnnAssign):
        return f"{node.target.id}: {ast.unparse(node.annotation)}"
    decorators = [d.id for d in node.decorator_list if isinstance(d, ast.Name)]
    returns = ast.unparse(node.returns) if node.returns else ""
    if "property" in decorators:
        return f"{node.name}: {returns}"
    args = ast.unparse(node.args)
    line = f"{node.name}({args}) -> {returns}"
    if len(line) > 88:
        parts = re.split(r"(?<!\*), (?=[\w*]+(?::|,|$))", args)
        line = f"{node.name}(\n    " + ",\n    ".join(parts) + f") -> {returns}"
    return line


def block(node, doc, classes):
    text = link_types(html.escape(declaration(node), quote=False), classes)
    name = node.target.id if isinstance(node, ast.AnnAssign) else node.name
    text = re.sub(rf"\b{name}\b", f"<b>{name}</b>", text, count=1)
    return f'<div class="member"><pre class="signature">{text}</pre>{paragraphs(doc)}</div>\n'


def class_lines(node, module, classes):
    cls = getattr(module, node.name)
    bases = ", ".join(link_types(ast.unparse(b), classes) for b in node.bases)
    yield f"## {node.name}\n"
    yield f'<pre class="signature">class <b>{node.name}</b>{f"({bases})" if bases else ""}</pre>\n'
    yield paragraphs(cls.__doc__ or "") + "\n"
    count = {}
    for item in node.body:
        if isinstance(item, (ast.FunctionDef, ast.AnnAssign)):
            name = item.target.id if isinstance(item, ast.AnnAssign) else item.name
            if isinstance(item, ast.AnnAssign):
                docs = [""]
            else:
                docs = docs_of(getattr(cls, name, None))
            at = count[name] = count.get(name, -1) + 1
            yield block(item, docs[at] if at < len(docs) else "", classes)


def page(package_folder, stub):
    """Returns the page of the package `hypotrack` in a folder such as build/release/python."""
    sys.path.insert(0, str(package_folder))
    module = importlib.import_module("hypotrack")
    tree = without_aliases(ast.parse(Path(stub).read_text()))
    classes = {n.name for n in tree.body if isinstance(n, ast.ClassDef)}
    summary, _, example = module.__doc__.partition("\n\n    ")
    title, _, rest = summary.partition("\n\n")
    lines = ["# Python package hypotrack\n", title + "\n", rest + "\n",
             "```python\nimport hypotrack\n\n" + re.sub(r"^    ", "", example, flags=re.M).rstrip() + "\n```\n",
             "[Track and experiment in Python](../howto/python.md) shows how. `ArrayLike` and `NDArray` are numpy's.\n"]
    functions = [n for n in tree.body if isinstance(n, ast.FunctionDef)]
    lines.append("## Functions\n")
    lines += [block(n, docs_of(getattr(module, n.name))[0], classes) for n in functions]
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            lines += class_lines(node, module, classes)
    return "\n".join(lines)
