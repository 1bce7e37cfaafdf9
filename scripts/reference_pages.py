"""Pages of reference for scripts/docs-site: the Python package's from its docstrings, and that of the
installed C++ headers from their comments, as Doxygen reads them."""

import ast
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def prose(text):
    """Text of comments in Markdown: names in back quotes stay code, and all else is as it is read."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([\\*_\[\]<>#|])", r"\\\1", part)
                   for part in parts)


# Python

def docstring_block(block):
    """A paragraph of a docstring: of prose, of code, or a list of names and what they mean."""
    lines = block.splitlines()
    if all(line.startswith("    ") for line in lines):
        return "```python\n" + "\n".join(line[4:] for line in lines) + "\n```"
    if not re.match(r"\w[\w, ]*?  +\S", lines[0]):
        return prose(" ".join(line.strip() for line in lines))
    rows = []
    for line in lines:
        name, _, meaning = line.partition("  ")
        if line.startswith(" "):
            rows[-1][1] += " " + line.strip()
        else:
            rows.append([name, meaning.strip()])
    return "| | |\n| --- | --- |\n" + "\n".join(f"| `{name}` | {prose(meaning)} |"
                                                for name, meaning in rows)


def docstring(node):
    text = ast.get_docstring(node) or ""
    return "\n\n".join(docstring_block(block) for block in re.split(r"\n\s*\n", text) if block)


def signature(node, name):
    words = ast.unparse(node.args)
    words = re.sub(r"^(self|cls)(, )?", "", words)
    result = f" -> {ast.unparse(node.returns)}" if node.returns is not None else ""
    return f"{name}({words}){result}".replace(" -> None", "")


def is_public(node):
    return isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_")


def python_fields(node, source):
    """The fields of a class, with the comments behind them."""
    rows = []
    for field in node.body:
        if isinstance(field, ast.AnnAssign) and not field.target.id.startswith("_"):
            comment = source[field.end_lineno - 1][field.end_col_offset:].partition("# ")[2]
            rows.append(f"| `{field.target.id}: {ast.unparse(field.annotation)}` | {prose(comment)} |")
    return ["| | |\n| --- | --- |\n" + "\n".join(rows)] if rows else []


def python_class(node, source, within):
    bases = ", ".join(name for base in node.bases if not (name := ast.unparse(base)).startswith("Native"))
    yield f"## {within}{node.name}\n\n```python\nclass {node.name}{f'({bases})' if bases else ''}\n```"
    yield docstring(node)
    yield from python_fields(node, source)
    for member in node.body:
        if isinstance(member, ast.FunctionDef) and member.name == "__init__":
            if ast.get_docstring(member):
                yield f"```python\n{signature(member, node.name)}\n```"
                yield docstring(member)
        elif is_public(member) and isinstance(member, ast.FunctionDef):
            kinds = {ast.unparse(decorator) for decorator in member.decorator_list}
            if any(kind.endswith(".setter") for kind in kinds):
                continue
            yield f"### {node.name}.{member.name}"
            if "property" in kinds:
                yield f"```python\n{member.name}: {ast.unparse(member.returns)}\n```"
            else:
                prefix = f"{node.name}." if {"classmethod", "staticmethod"} & kinds else ""
                yield f"```python\n{signature(member, prefix + member.name)}\n```"
            yield docstring(member)


def python_page():
    """Everything that `uwvdb.__all__` names, and nothing else."""
    folder = ROOT / "python/uwvdb"
    package = ast.parse((folder / "__init__.py").read_text())
    exported = next(ast.literal_eval(node.value) for node in package.body
                    if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    parts = ["# Python reference", docstring(package).partition("\n\ndocs/")[0],
             "[Python](python.md) explains how to use it, with examples."]
    for node in package.body:
        if not isinstance(node, ast.ImportFrom) or node.module == "_uwvdb":
            continue
        for alias in node.names:
            if alias.name not in exported:
                continue
            file = folder / f"{node.module or alias.name}.py"
            text = file.read_text()
            tree = ast.parse(text)
            found = {member.name: member for member in tree.body if is_public(member)}
            if node.module is None:  # a module of its own
                parts += [f"## {alias.name}", docstring(tree)]
                names, within = list(found), alias.name + "."
            else:
                names, within = [alias.name], ""
            for name in names:
                member = found[name]
                if isinstance(member, ast.ClassDef):
                    parts += python_class(member, text.splitlines(), within)
                else:
                    parts += [f"## {within}{name}", f"```python\n{signature(member, name)}\n```",
                              docstring(member)]
    return "\n\n".join(part for part in parts if part) + "\n"


# C++

DOXYFILE = """\
INPUT = {headers}
OUTPUT_DIRECTORY = {out}
STRIP_FROM_PATH = {root}
FILTER_PATTERNS = *.h={filter}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
EXTRACT_ALL = YES
INCLUDE_GRAPH = NO
INCLUDED_BY_GRAPH = NO
QUIET = YES
MAX_INITIALIZER_LINES = 1
"""
# Comments behind members, which are ordinary ones, are what is said of these.
FILTER = """#!/bin/sh
sed -E 's@([;,])([ ]+)// @\\1\\2///< @' "$1"
"""
KINDS = ("class", "struct", "namespace", "concept")


def of_xml(node):
    """A description as Markdown."""
    def inline(element):
        text = prose(element.text or "")
        for child in element:
            if child.tag in ("computeroutput", "ref", "bold", "emphasis"):
                inner = "".join(child.itertext())
                text += f"`{inner}`" if child.tag == "computeroutput" else prose(inner)
            elif child.tag in ("itemizedlist", "orderedlist"):
                text += "\n\n" + "\n".join("- " + " ".join(
                    inline(para) for para in item.iter("para")).strip() for item in child) + "\n\n"
            elif child.tag in ("programlisting", "verbatim", "preformatted"):
                lines = (["".join(" " if part.tag == "sp" else part.text or ""
                                  for part in line.iter()) for line in child.iter("codeline")]
                         or [child.text or ""])
                text += "\n\n```cpp\n" + "\n".join(lines) + "\n```\n\n"
            elif child.tag == "blockquote":  # a line of a comment that begins with "> 0"
                text += "\\> " + " ".join(inline(para) for para in child.iter("para"))
            elif child.tag in ("ulink", "ndash", "lsquo", "rsquo", "zwj", "table", "sp", "linebreak"):
                text += {"ndash": "--", "lsquo": "'", "rsquo": "'"}.get(
                    child.tag, prose("".join(child.itertext())))
            else:
                raise SystemExit(f"docs-site: a comment has {child.tag}, which its page has no form for")
            text += prose(child.tail or "")
        return text
    return "\n\n".join(part for para in node.findall("para") if (part := inline(para).strip()))


def said_of(node):
    return "\n\n".join(part for tag in ("briefdescription", "detaileddescription")
                       if (part := of_xml(node.find(tag))))


def words_of(node, tag):
    """The text of a child, written as the code is."""
    found = node.find(tag)
    text = "".join(found.itertext()).strip() if found is not None else ""
    text = re.sub(r"< (?=\S)|(?<=\S) (?=>)", lambda part: part[0].strip(), text)
    return re.sub(r" ([&*]+) ?(?=[\w.])", r"\1 ", text)


def declaration(member):
    kind, name = member.get("kind"), words_of(member, "name")
    template = ", ".join(" ".join(filter(None, (words_of(p, "type"), words_of(p, "declname"))))
                         for p in member.findall("templateparamlist/param"))
    head = f"template <{template}>\n" if template else ""
    words = re.sub(r"\buw::(\w+::)*(?=(~?\w+|operator\W+)$)", "", words_of(member, "definition"))
    if kind == "enum":
        values = ", ".join(words_of(value, "name") for value in member.findall("enumvalue"))
        return f"enum {'class ' if member.get('strong') == 'yes' else ''}{name} {{ {values} }};"
    if kind == "function":
        return f"{head}{words}{words_of(member, 'argsstring')};"
    if kind == "typedef":
        return f"{head}using {name} = {words_of(member, 'type')};"
    initial = words_of(member, "initializer")
    if len(initial) > 60:
        initial = "= ..."
    return f"{head}{words}{' ' if initial.startswith('=') else ''}{initial};"


def members(compound):
    """The documented or plain members of a class or a namespace, by the file that they are in."""
    for member in compound.iter("memberdef"):
        if member.get("prot") == "public" and member.get("kind") in (
                "function", "variable", "typedef", "enum"):
            place = member.find("location")
            yield place.get("declfile") or place.get("file"), int(place.get("line")), member


def member_text(members):
    """Declarations that belong together in one block, with what is said of them below it."""
    parts, block = [], []

    def flush():
        if block:
            parts.append("```cpp\n" + "\n".join(block) + "\n```")
            block.clear()
    for member in members:
        said = said_of(member)
        values = [f"- `{words_of(value, 'name')}`: {text}" for value in member.findall("enumvalue")
                  if (text := said_of(value))]
        block.append(declaration(member))
        if member.get("kind") == "variable" and len(said) < 70 and "\n" not in said and said:
            block[-1] += "  // " + re.sub(r"\\(.)", r"\1", said)
        elif said or values:
            flush()
            parts += filter(None, [said, "\n".join(values)])
    flush()
    return parts


def cpp_pages():
    """The text of each page by its name: one for each folder, and a first one that lists them."""
    printed = subprocess.run(["cmake", "-D", "PRINT=core;media;camera;render", "-P",
                              ROOT / "cmake/PublicHeaders.cmake"], check=True, capture_output=True,
                             text=True, cwd=ROOT).stdout.split()
    with tempfile.TemporaryDirectory() as folder:
        out, settings, filtering = (Path(folder, name) for name in ("out", "Doxyfile", "filter"))
        filtering.write_text(FILTER)
        filtering.chmod(0o755)
        settings.write_text(DOXYFILE.format(headers=" ".join(printed), out=out, root=ROOT,
                                            filter=filtering))
        ran = subprocess.run(["doxygen", settings], cwd=ROOT, capture_output=True, text=True)
        if ran.returncode != 0 or ran.stderr.strip():
            raise SystemExit(f"docs-site: doxygen: {ran.stderr.strip()}")
        compounds = [compound for file in sorted((out / "xml").glob("*.xml"))
                     for compound in ElementTree.parse(file).getroot().iter("compounddef")
                     if compound.get("kind") in KINDS and compound.get("prot", "public") == "public"]
    in_header = {header: [] for header in printed}
    for compound in compounds:
        name = words_of(compound, "compoundname").removeprefix("uw::")
        if compound.get("kind") == "namespace":
            for file, line, member in members(compound):
                if file in in_header:
                    in_header[file].append((line, member_text([member])))
            continue
        place = compound.find("location")
        if place.get("file") not in in_header or "anonymous" in name or "@" in name:
            continue
        own = [member for _, _, member in sorted(members(compound), key=lambda found: found[:2])]
        parts = [f"### {compound.get('kind')} {name}", said_of(compound), *member_text(own)]
        in_header[place.get("file")].append((int(place.get("line")), parts))
    pages, first = {}, []
    for header, found in in_header.items():
        room = header.rpartition("/")[0]
        page = f"cpp-{room.replace('/', '-')}.md"
        if page not in pages:
            pages[page] = [f"# C++: {room}"]
            first.append(f"- [{room}]({page})")
        pages[page] += [f"## {header}", f"```cpp\n#include \"{header}\"\n```"]
        for _, parts in sorted(found, key=lambda item: item[0]):
            pages[page] += filter(None, parts)
    texts = {page: "\n\n".join(parts) + "\n" for page, parts in pages.items()}
    texts["cpp.md"] = (
        "# C++ headers\n\nWhat `cmake --install` installs, by folders ([how to build with it]"
        "(install.md#in-a-c-program), [how the folders depend on each other](design.md)). Everything is in "
        "the namespace `uw`. Begin with `render/renderer.h` in [render](cpp-render.md). Between minor "
        "versions [anything may change](stability.md).\n\n" + "\n".join(first) + "\n")
    return texts
