#!/usr/bin/env python3
"""Counts sentences that dangle: those that open with "What" and ask nothing, or with "Of", "Where", "As" or "By" and
have no comma, after which a main clause could come. Looks at prose of pages, without headings and code, at comments, at
docstrings and at help texts. Prints a figure for each group and exits with 1 if a group exceeds its limit; -v prints
each sentence."""
import ast
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
OPENER = re.compile(r"(What\b(?!.*\?$)|(?:Of|Where|As|By(?! default))\b(?!.*,)).*", re.S)
CPP_COMMENT = re.compile(r"^(\s*)(.*?)//+ ?(.*)$")
HASH_COMMENT = re.compile(r"^(\s*)((?:[^#'\"]*\s)?)#(?!!) ?(.*)$")
LITERAL = r'"((?:[^"\\\n]|\\.)*)"'
# The texts of a command's options, and of its description: adjacent literals after one of these.
HELP = re.compile(rf"(?:\.(?:help|summary|description) =|add_(?:option|flag)\(.*?,|CLI::App app\()\s*({LITERAL}(?:\s*{LITERAL})*)", re.S)


def pieces_of_page(text):
    """(line, text) of paragraphs, items and cells."""
    is_code, first, piece = False, 0, ""
    for number, line in enumerate([*text.splitlines(), ""], 1):
        is_code ^= line.startswith("```")
        begins = re.match(r"\s*(?:[-*]|\d+\.) ", line)
        is_prose = not is_code and not line.startswith(("```", "#", "|")) and line.strip()
        if piece and (begins or not is_prose):
            yield first, piece
            piece = ""
        if line.startswith("|") and not is_code:
            yield from ((number, cell) for cell in line.strip("|").split("|"))
        elif is_prose:
            first = first if piece else number
            piece += " " + line[begins.end() if begins else 0 :]


def pieces_of_code(text, comment):
    """(line, text) of comments; consecutive ones that fill their lines belong together."""
    first, piece = 0, ""
    for number, line in enumerate([*text.splitlines(), ""], 1):
        found = comment.match(line)
        if piece and not (found and not found[2]):
            yield first, piece
            piece = ""
        if found:
            first = first if piece else number
            piece += " " + found[3]


def pieces_of_docstrings(text):
    """(line, text) of their paragraphs."""
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)):
            continue
        docstring = ast.get_docstring(node)
        for paragraph in re.split(r"\n\s*\n|\n(?=\S+ :)", docstring or ""):
            yield getattr(node, "lineno", 1), re.sub(r"^[^\n]* : [^\n]*\n|\s+", " ", paragraph)


def pieces_of_help(text):
    """(line, text) of help texts, which need not begin with a capital letter."""
    for found in HELP.finditer(text):
        joined = "".join(re.findall(LITERAL, found[1]))
        yield text.count("\n", 0, found.start()) + 1, joined[:1].upper() + joined[1:]


def pieces_of_cpp(text):
    return pieces_of_code(text, CPP_COMMENT)


def pieces_of_script(text):
    return pieces_of_code(text, HASH_COMMENT)


CPP = ["*.h", "*.cpp", "*.comp", "*.glsl", "*.rgen", "*.rchit", "*.rahit", "*.rmiss", "*.rint", "*.frag", "*.vert"]
# The files of a group as git lists them, its pieces, and the largest share of its pieces that may have such a sentence.
GROUPS = {
    "README.md": (["README.md"], pieces_of_page, 0),
    "docs": (["docs/*.md"], pieces_of_page, 0.01),
    "help": (["cli/*.cpp", "samples/*.cpp"], pieces_of_help, 0),
    "docstrings": (["bindings/python/twinray/*.py"], pieces_of_docstrings, 0),
    "public headers": (["include/*.h"], pieces_of_cpp, 0),
    "other C++ and GLSL": ([*CPP, ":!include/*"], pieces_of_cpp, 0.01),
    "scripts": (["*.py", "*.sh", "*.cmake", "*CMakeLists.txt"], pieces_of_script, 0.01),
}


def plain(text):
    return re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text).replace("*", "").strip()


def dangling_in(piece):
    return [s for s in re.split(r"(?<=[.!?])\s+", plain(piece)) if OPENER.fullmatch(s)]


status = 0
for group, (patterns, pieces_of, most) in GROUPS.items():
    count, found = 0, []
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=root, check=True, capture_output=True, text=True).stdout
    for name in listed.split():
        for number, piece in pieces_of((root / name).read_text(encoding="utf-8")):
            count += 1
            found += [f"{name}:{number}: {sentence}" for sentence in dangling_in(piece)]
    is_over = len(found) > most * count
    status |= is_over
    if is_over or "-v" in sys.argv:
        print("\n".join(found))
    print(f"openers: {group}: {len(found)} in {count} pieces, {len(found) / max(count, 1):.1%} (at most {most:.0%})")
sys.exit(status)
