"""Pages of the reference: one for each header of C++, which Breathe fills from Doxygen's XML; one for each header of
kernels, from what that XML says of files and what they declare, with comments as Markdown; and one for each command:
what `twinray help COMMAND` prints."""

import pathlib
import re
import subprocess
import xml.etree.ElementTree as ElementTree

DESCRIPTIONS = ("briefdescription", "detaileddescription", "inbodydescription")
# Headers that are only a way to include others, or that C++ alone reads.
NOT_FOR_KERNELS = {"cpp.h", "cpp_begin.h", "cpp_end.h", "cpp_sampling.h", "cpp_spawn.h", "vector_math.h"}
SECTIONS = (
    "briefdescription detaileddescription define enum func innerclass public-attrib public-func public-static-attrib "
    "public-static-func public-type typedef user-defined var"
)
# In the order in which one meets them.
ORDER = ("geometry", "trace", "abstract_accel", "tlas", "context", "commands", "device_mesh", "world", "scene", "sets",
         "queries", "analysis", "validation", "vma_adapter")  # fmt: skip


def compounds(folder):
    """The compounds of all files of the XML."""
    for file in sorted(folder.glob("*.xml")):
        if file.name not in ("index.xml", "Doxyfile.xml"):
            yield from ElementTree.parse(file).getroot().iter("compounddef")


def text_of(node):
    return "" if node is None else "".join(node.itertext())


def is_documented(node):
    return any(text_of(node.find(kind)).strip() for kind in DESCRIPTIONS)


def escaped(text):
    for character in "\\`*_<>[]|#$":
        text = text.replace(character, "\\" + character)
    return text


def markdown_of(node):
    """The blocks of a description."""
    blocks, text = [], ""

    def end_paragraph():
        nonlocal text
        if text.strip():
            blocks.append(text.strip())
        text = ""

    def visit(element):
        nonlocal text
        text += escaped(element.text or "")
        for child in element:
            if child.tag == "programlisting":
                end_paragraph()
                code = "\n".join(code_line(line) for line in child.iter("codeline"))
                blocks.append(f"```glsl\n{code}\n```")
            elif child.tag == "itemizedlist":
                end_paragraph()
                blocks.append("\n".join("- " + escaped(" ".join(text_of(item).split())) for item in child))
            else:
                visit(child)
                if child.tag == "para":
                    end_paragraph()
            text += escaped(child.tail or "")

    visit(node)
    end_paragraph()
    return blocks


def code_line(line):
    text = ""
    for element in line.iter():
        if element.tag == "sp":
            text += " "
        text += element.text or ""
        if element is not line:
            text += element.tail or ""
    return text


def described(node):
    return [block for kind in DESCRIPTIONS if node.find(kind) is not None for block in markdown_of(node.find(kind))]


def first_sentence(header):
    lines = header.read_text(encoding="utf-8").split("\n")[1:]
    text = ""
    for line in lines:
        if not line.startswith("// ") or line.startswith("//  "):
            break
        text += line.removeprefix("//")
    return text.strip().split(". ")[0].rstrip(".") + "."


def cpp_page_of(name):
    return f"# `<twinray/{name}.h>`\n\n```{{doxygenfile}} {name}.h\n:sections: {SECTIONS}\n```\n"


def index_of(introduction, rows, names):
    """A page that lists headers in a table and leads to their pages."""
    table = "| header | what is there |\n|---|---|\n" + "\n".join(rows)
    return f"{introduction}\n\n{table}\n\n```{{toctree}}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"


def write_cpp(folder, headers):
    folder.mkdir(parents=True)
    names = sorted(
        (header.stem for header in headers.glob("*.h") if header.stem != "twinray"),
        key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name),
    )
    rows = [f"| [`<twinray/{name}.h>`]({name}.md) | {first_sentence(headers / f'{name}.h')} |" for name in names]
    introduction = (
        "# C++\n\nWhat `include/twinray` declares in namespace `twinray`, from its comments. "
        "`<twinray/twinray.h>` includes what traces rays."
    )
    (folder / "index.md").write_text(index_of(introduction, rows, names), encoding="utf-8")
    for name in names:
        (folder / f"{name}.md").write_text(cpp_page_of(name), encoding="utf-8")


def is_guard(member):
    return member.get("kind") == "define" and member.find("initializer") is None and member.find("param") is None


def is_own(member):
    """A name that ends in _ is a macro's own."""
    return member.findtext("name").endswith("_")


def signature(member):
    kind = member.get("kind")
    type_of = text_of(member.find("type")).strip()
    name = member.findtext("name")
    if kind == "function":
        return f"{type_of} {name}{member.findtext('argsstring')}"
    if kind == "define":
        params = [text_of(param).strip() for param in member.findall("param")]
        return f"#define {name}" + (f"({', '.join(params)})" if params and params != [""] else "")
    value = text_of(member.find("initializer")).strip()
    return f"{type_of} {name}" + (f" {value}" if value else "")


def struct_text(compound):
    lines = [f"struct {compound.findtext('compoundname')} {{"]
    for member in compound.iter("memberdef"):
        comment = " ".join("".join(text_of(member.find(kind)) for kind in DESCRIPTIONS).split())
        lines.append(
            f"    {text_of(member.find('type'))} {member.findtext('name')};" + (f"  // {comment}" * bool(comment))
        )
    return "\n".join([*lines, "};"])


def structs_by_file(folder):
    found = {}
    for compound in compounds(folder):
        if compound.get("kind") == "struct" and "::" not in compound.findtext("compoundname"):
            found.setdefault(pathlib.Path(compound.find("location").get("file")).name, []).append(compound)
    return found


def members_of(compound):
    seen = set()
    for member in compound.iter("memberdef"):
        key = signature(member)
        if not (is_guard(member) or is_own(member) or key in seen):
            seen.add(key)
            yield member


def grouped(members):
    """Overloads of one comment together."""
    groups = []
    for member in members:
        key = (member.findtext("name"), "\n\n".join(described(member)))
        if groups and groups[-1][0] == key:
            groups[-1][1].append(member)
        else:
            groups.append((key, [member]))
    return groups


def glsl_page_of(compound, structs):
    name = compound.findtext("compoundname")
    parts = [f"# `twinray/glsl/{name}`", *described(compound)]
    for struct in structs:
        parts += [
            f"## `{struct.findtext('compoundname')}`",
            f"```glsl\n{struct_text(struct)}\n```",
            *described(struct),
        ]
    for (title, comment), members in grouped(members_of(compound)):
        code = "\n".join(signature(member) for member in members)
        parts += [f"## `{title}`", f"```glsl\n{code}\n```", comment]
    return "\n\n".join(part for part in parts if part) + "\n"


def write_glsl(folder, xml_folder, headers):
    folder.mkdir(parents=True)
    structs = structs_by_file(xml_folder)
    rows, names = [], []
    for compound in compounds(xml_folder):
        name = compound.findtext("compoundname")
        if compound.get("kind") != "file" or name in NOT_FOR_KERNELS:
            continue
        page = name.replace(".", "_")
        names.append(page)
        rows.append(f"| [`twinray/glsl/{name}`]({page}.md) | {escaped(first_sentence(headers / name))} |")
        (folder / f"{page}.md").write_text(glsl_page_of(compound, structs.get(name, [])), encoding="utf-8")
    introduction = (
        "# GLSL\n\nWhat kernels of yours include, from the headers' comments. "
        "[Kernels](../../kernels.md) is the manual."
    )
    (folder / "index.md").write_text(index_of(introduction, rows, names), encoding="utf-8")


def help_of(twinray, *command):
    result = subprocess.run([twinray, "help", *command], capture_output=True, text=True, check=True)
    return result.stdout.rstrip()


def names_of(overview):
    """The commands that an overview lists: those of its lines that are indented by four."""
    return re.findall(r"^    ([a-z]+)  +\S", overview, re.M)


def write_commands(folder, twinray):
    folder.mkdir(parents=True)
    overview = help_of(twinray)
    names = names_of(overview)
    (folder / "index.md").write_text(
        f"# Commands\n\n```text\n{overview}\n```\n\nWhat they share: [the command line](../../command.md).\n\n"
        "```{toctree}\n:maxdepth: 1\n\n" + "\n".join(names) + "\n```\n",
        encoding="utf-8",
    )
    for name in names:
        page = f"# `twinray {name}`\n\n```text\n{help_of(twinray, name)}\n```\n"
        (folder / f"{name}.md").write_text(page, encoding="utf-8")
