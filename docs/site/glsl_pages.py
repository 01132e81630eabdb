# SPDX-License-Identifier: MIT
"""Pages of the GLSL reference: one for each header of kernels, from Doxygen's XML."""

import pathlib

import doxygen_xml as xml
from cpp_pages import first_sentence, index_of

# Headers that are only a way to include others, or that C++ alone reads.
NOT_FOR_KERNELS = {"cpp.h", "cpp_begin.h", "cpp_end.h", "cpp_sampling.h", "cpp_spawn.h", "vector_math.h"}


def is_guard(member):
    return member.get("kind") == "define" and member.find("initializer") is None and member.find("param") is None


def is_own(member):
    """A name that ends in _ is a macro's own."""
    return member.findtext("name").endswith("_")


def signature(member):
    kind = member.get("kind")
    type_of = xml.text_of(member.find("type")).strip()
    name = member.findtext("name")
    if kind == "function":
        return f"{type_of} {name}{member.findtext('argsstring')}"
    if kind == "define":
        params = [xml.text_of(param).strip() for param in member.findall("param")]
        return f"#define {name}" + (f"({', '.join(params)})" if params and params != [""] else "")
    value = xml.text_of(member.find("initializer")).strip()
    return f"{type_of} {name}" + (f" {value}" if value else "")


def struct_text(compound):
    lines = [f"struct {compound.findtext('compoundname')} {{"]
    for member in compound.iter("memberdef"):
        comment = " ".join("".join(xml.text_of(member.find(kind)) for kind in xml.DESCRIPTIONS).split())
        lines.append(
            f"    {xml.text_of(member.find('type'))} {member.findtext('name')};" + (f"  // {comment}" * bool(comment))
        )
    return "\n".join([*lines, "};"])


def structs_by_file(folder):
    found = {}
    for compound in xml.compounds(folder):
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
        key = (member.findtext("name"), "\n\n".join(xml.described(member)))
        if groups and groups[-1][0] == key:
            groups[-1][1].append(member)
        else:
            groups.append((key, [member]))
    return groups


def page_of(compound, structs):
    name = compound.findtext("compoundname")
    parts = [f"# `twinray/glsl/{name}`", *xml.described(compound)]
    for struct in structs:
        parts += [
            f"## `{struct.findtext('compoundname')}`",
            f"```glsl\n{struct_text(struct)}\n```",
            *xml.described(struct),
        ]
    for (title, comment), members in grouped(members_of(compound)):
        code = "\n".join(signature(member) for member in members)
        parts += [f"## `{title}`", f"```glsl\n{code}\n```", comment]
    return "\n\n".join(part for part in parts if part) + "\n"


def write(folder, xml_folder, headers):
    folder.mkdir(parents=True)
    structs = structs_by_file(xml_folder)
    rows, names = [], []
    for compound in xml.compounds(xml_folder):
        name = compound.findtext("compoundname")
        if compound.get("kind") != "file" or name in NOT_FOR_KERNELS:
            continue
        page = name.replace(".", "_")
        names.append(page)
        rows.append(f"| [`twinray/glsl/{name}`]({page}.md) | {xml.escaped(first_sentence(headers / name))} |")
        (folder / f"{page}.md").write_text(page_of(compound, structs.get(name, [])), encoding="utf-8")
    introduction = (
        "# GLSL\n\nWhat kernels of yours include, from the headers' comments. "
        "[Kernels](../../kernels.md) is the manual."
    )
    (folder / "index.md").write_text(index_of(introduction, rows, names), encoding="utf-8")
