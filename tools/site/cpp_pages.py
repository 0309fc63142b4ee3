"""Makes a page for each public C++ header from Doxygen's XML."""
import html
import re
import textwrap

import doxygen
from python_pages import link_pages

HIDDEN = re.compile(r"::(detail|internal)(::|$)")
SHELVES = ["api", "plugin", "gpu"]
FUNCTIONS = ("function", "variable", "typedef", "enum", "define")


def without_targets(name):
    """Returns a name without the namespace that each instruction set has."""
    return re.sub(r"(HWY_NAMESPACE|HYPOTRACK_TARGET)::", "", name)


def name_of(compound):
    return without_targets(compound.findtext("compoundname"))


def is_public(member):
    name = member.findtext("name")
    text = member.findtext("definition", "") + member.findtext("argsstring", "")
    return (member.get("prot") != "private" and member.get("kind") in FUNCTIONS and "@" not in name
            and not name.endswith("_") and not name.startswith("~") and not text.endswith(("=delete", "= delete"))
            and not HIDDEN.search(member.findtext("qualifiedname", "")))


class Header:
    def __init__(self, name):
        self.name = name  # hypotrack/api/tracker.hpp
        self.classes, self.members = [], []

    @property
    def page(self):
        return self.name.removeprefix("hypotrack/").replace("/", "_") + ".md"


class Api:
    def __init__(self, compounds):
        self.compounds, self.headers, self.places = compounds, {}, {}
        for compound in compounds.values():
            kind = compound.get("kind")
            if HIDDEN.search(name_of(compound)) or compound.get("prot") == "private":
                continue
            if kind in ("class", "struct") and "<" not in name_of(compound):
                self.header(compound).classes.append(compound)
            elif kind in ("namespace", "file"):
                for member in compound.iter("memberdef"):
                    if is_public(member):
                        self.header(member).members.append(member)
        for header in self.headers.values():
            self.tidy(header)

    def header(self, element):
        name = element.find("location").get("file")
        return self.headers.setdefault(name, Header(name))

    def tidy(self, header):
        """Brings a header's parts into the order of its lines, and notes where each stands."""
        line = lambda e: int(e.find("location").get("line"))
        header.classes.sort(key=line)
        header.members = sorted({m.get("id"): m for m in header.members}.values(), key=line)
        for compound in header.classes:
            self.places[compound.get("id")] = (header.page, anchor(name_of(compound)))
            for member in filter(is_public, compound.iter("memberdef")):
                self.places[member.get("id")] = (header.page, anchor(scoped_name(member)))
        for member in header.members:
            self.places[member.get("id")] = (header.page, anchor(scoped_name(member)))

    def inline(self, element, code=False):
        """Returns HTML of a type or a text of Doxygen's."""
        if element is None:
            return ""
        parts = [html.escape(element.text or "", quote=False)]
        for child in element:
            inner = self.inline(child, code or child.tag == "computeroutput")
            parts.append(self.wrapped(child, inner))
            parts.append(html.escape(child.tail or "", quote=False))
        return "".join(parts)

    def wrapped(self, child, inner):
        place = self.places.get(child.get("refid"))
        if child.tag == "ref":
            return f'<a href="{place[0].removesuffix(".md")}.html#{place[1]}">{inner}</a>' if place else inner
        tags = {"computeroutput": "code", "emphasis": "em", "bold": "strong", "itemizedlist": "ul",
                "orderedlist": "ol", "listitem": "li", "programlisting": "pre"}
        if child.tag == "sp":
            return " "
        if child.tag == "codeline":
            return inner + "\n"
        if child.tag == "verbatim":
            code = re.sub(r"^\s*/// ?", "", inner, flags=re.M)
            return f"<pre class='signature'>{textwrap.dedent(code).strip()}</pre>"
        if child.tag == "para":
            return paragraph(inner)
        tag = tags.get(child.tag)
        return f"<{tag}>{inner}</{tag}>" if tag else inner

    def base(self, element):
        name, place = html.escape(element.text), self.places.get(element.get("refid"))
        return f'<a href="{place[0].removesuffix(".md")}.html#{place[1]}">{name}</a>' if place else name

    def description(self, element):
        text = "".join(self.inline(element.find(tag)) for tag in ("briefdescription", "detaileddescription")).strip()
        return link_pages(text, "../..")


def paragraph(inner):
    """Returns a paragraph; lists and code stand between paragraphs."""
    text = re.sub(r"(<(pre|ul|ol)[^>]*>.*?</\2>)", r"</p>\1<p>", f"<p>{inner.strip()}</p>", flags=re.S)
    return re.sub(r"<p>\s*</p>", "", text)


def anchor(name):
    return re.sub(r"[^a-z0-9_]+", "-", name.removeprefix("hypotrack::").lower()).strip("-")


def scoped_name(member):
    return without_targets(member.findtext("qualifiedname") or member.findtext("name"))


def joined(type_html):
    """`const Frame &` as the sources write it."""
    text = re.sub(r"\s+([&*]+)", r"\1", type_html)
    return re.sub(r"&lt;\s+|\s+&gt;", lambda m: m[0].strip(), text)


def template(api, element):
    found = element.find("templateparamlist")
    if found is None:
        return ""
    params = [" ".join(filter(None, (api.inline(p.find("type")), p.findtext("declname", "")))) for p in found.findall("param")]
    return f"template &lt;{', '.join(params)}&gt;\n"


def parameter(api, param):
    text = joined(api.inline(param.find("type")))
    if param.findtext("declname"):
        text += f" {param.findtext('declname')}" + html.escape(param.findtext("array") or "")
    if param.find("defval") is not None:
        text += " = " + joined(api.inline(param.find("defval")))
    return text


def signature(api, member, in_class):
    """Returns the declaration of a member as HTML with links to types."""
    name = member.findtext("name") if in_class else scoped_name(member).removeprefix("hypotrack::")
    kind, name = member.get("kind"), html.escape(name)
    kind_type = joined(api.inline(member.find("type")))
    if kind == "define":
        params = [p.findtext("defname", "") for p in member.findall("param")]
        return f"#define <b>{name}</b>" + (f"({', '.join(params)})" if params else "")
    if kind == "typedef":
        return f"{template(api, member)}using <b>{name}</b> = {kind_type}{html.escape(member.findtext('argsstring') or '')}"
    if kind == "enum":
        strong = "class " if member.get("strong") == "yes" else ""
        return f"enum {strong}<b>{name}</b>"
    prefix = "static " if member.get("static") == "yes" and not kind_type.startswith("static") else ""
    if kind == "variable":
        init = member.findtext("initializer") or ""
        init = joined(api.inline(member.find("initializer"))) if len(init) < 60 and "\n" not in init else ""
        return f"{template(api, member)}{prefix}{kind_type} <b>{name}</b>{html.escape(member.findtext('argsstring') or '')} {init}".rstrip()
    params = [parameter(api, p) for p in member.findall("param")]
    args = member.findtext("argsstring") or ""
    tail = html.escape(args[args.rfind(")") + 1:].replace("=0", " = 0").replace("=default", " = default"))
    virtual = "virtual " if member.get("virt") != "non-virtual" and "virtual" not in kind_type else ""
    head = f"{template(api, member)}{prefix}{virtual}{kind_type} ".lstrip() + f"<b>{name}</b>("
    one_line = re.sub(r"<[^>]*>", "", head.split("\n")[-1] + ", ".join(params))
    if len(html.unescape(one_line)) > 88 and len(params) > 1:
        return head + "\n    " + ",\n    ".join(params) + ")" + tail
    return head + ", ".join(params) + ")" + tail


def member_block(api, member, in_class=False):
    text = api.description(member)
    for value in member.findall("enumvalue"):
        init = html.escape(value.findtext("initializer") or "")
        text += f"<p><code>{html.escape(value.findtext('name'))} {init}".rstrip() + f"</code> {strip_p(api.description(value))}</p>"
    name = anchor(scoped_name(member))
    return f'<div class="member" id="{name}"><pre class="signature">{signature(api, member, in_class)}</pre>{text}</div>'


def strip_p(text):
    return text.removeprefix("<p>").removesuffix("</p>")


def class_block(api, compound):
    name = name_of(compound)
    bases = ", ".join(api.base(b) for b in compound.findall("basecompoundref"))
    yield f"## {name.removeprefix('hypotrack::')} {{#{anchor(name)}}}\n"
    head = f"{template(api, compound)}{compound.get('kind')} <b>{html.escape(name)}</b>" + (f" : {bases}" if bases else "")
    yield f'<pre class="signature">{head}</pre>\n\n{api.description(compound)}\n'
    for section in sorted(compound.findall("sectiondef"), key=lambda s: "protected" in s.get("kind")):
        blocks = [member_block(api, m, True) for m in section.findall("memberdef") if is_public(m)]
        if blocks and "protected" in section.get("kind"):
            yield "<p><b>Protected</b></p>\n"
        yield "\n".join(blocks) + "\n"


SECTIONS = {"Types": ("typedef", "enum"), "Functions": ("function",), "Constants": ("variable",), "Macros": ("define",)}


def header_page(api, header):
    lines = [f"# {short(header.name)}\n", f"```cpp\n#include <{header.name}>\n```\n"]
    for compound in header.classes:
        lines += class_block(api, compound)
    for title, kinds in SECTIONS.items():
        blocks = [member_block(api, m) for m in header.members if m.get("kind") in kinds]
        if blocks:
            lines += [f"## {title}\n", *blocks, ""]
    return "\n".join(lines)


def short(name):
    return name.removeprefix("hypotrack/")


def pages(headers, scratch):
    """Yields (name, text) of a page for each header and of their index."""
    api = Api(doxygen.read_xml(headers, scratch))
    shown = sorted((h for h in api.headers.values() if h.classes or h.members), key=lambda h: (SHELVES.index(h.name.split("/")[1]), h.name))
    rows = []
    for header in shown:
        names = [name_of(c).removeprefix("hypotrack::") for c in header.classes if "::" not in name_of(c).removeprefix("hypotrack::")]
        names += dict.fromkeys(m.findtext("name") for m in header.members)
        rows.append(f"| [{short(header.name)}]({header.page}) | {', '.join(f'`{n}`' for n in names[:8])} |")
        yield header.page, header_page(api, header)
    intro = ("# C++ headers\n\nPrograms that track include `api/`, plugins also `plugin/`, their parts for GPUs also `gpu/`. "
             "[Track from a program of your own](../../howto/embed.md) and [write a plugin](../../contributing.md) show how.\n\n")
    yield "index.md", intro + "| header | declares |\n|---|---|\n" + "\n".join(rows) + "\n"
