# SPDX-License-Identifier: MIT
"""What Doxygen's XML says of headers: files, what they declare, and its comments as Markdown."""

import xml.etree.ElementTree as ElementTree

DESCRIPTIONS = ("briefdescription", "detaileddescription", "inbodydescription")


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
