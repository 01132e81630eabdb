#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts sentences that dangle: those that open with "What" and ask nothing, or with "Of", "Where", "As" or "By" and
have no comma, after which a main clause could come. Looks at prose of pages, without headings and code, and at comments
of headers. Prints a figure for each group and exits with 1 where a group has more than it may; -v prints each."""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
# What git lists for a group, and which share of its lines may have such a sentence; None: not held to it yet.
GROUPS = {
    "README.md": (["README.md"], 0),
    "docs": (["docs/*.md"], 0.01),
    "public headers": (["include/*.h"], None),
    "other headers": (["*.h", ":!include/*"], None),
}
OPENER = re.compile(r"(What\b(?!.*\?$)|(?:Of|Where|As|By(?! default))\b(?!.*,)).*", re.S)
COMMENT = re.compile(r"^(\s*)(.*?)//+ ?(.*)$")


def pieces_of_page(lines):
    """(line, text) of paragraphs, items and cells."""
    is_code, first, piece = False, 0, ""
    for number, line in enumerate([*lines, ""], 1):
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


def pieces_of_header(lines):
    """(line, text) of comments; lines of one that fill their line belong together."""
    first, piece = 0, ""
    for number, line in enumerate([*lines, ""], 1):
        found = COMMENT.match(line)
        if piece and not (found and not found[2]):
            yield first, piece
            piece = ""
        if found:
            first = first if piece else number
            piece += " " + found[3]


def plain(text):
    return re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text).replace("*", "").strip()


def dangling_of(pieces):
    for number, piece in pieces:
        for sentence in re.split(r"(?<=[.!?])\s+", plain(piece)):
            if OPENER.fullmatch(sentence):
                yield number, sentence


status = 0
for group, (patterns, most) in GROUPS.items():
    count, found = 0, []
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=root, check=True, capture_output=True, text=True).stdout
    for name in listed.split():
        lines = (root / name).read_text(encoding="utf-8").splitlines()
        is_page = name.endswith(".md")
        count += sum(bool(line.strip() if is_page else COMMENT.match(line)) for line in lines)
        pieces = (pieces_of_page if is_page else pieces_of_header)(lines)
        found += [f"{name}:{number}: {sentence}" for number, sentence in dangling_of(pieces)]
    is_over = most is not None and len(found) > most * count
    status |= is_over
    if is_over or "-v" in sys.argv:
        print("\n".join(found))
    limit = "not held to a limit yet" if most is None else f"at most {most:.0%}"
    print(f"openers: {group}: {len(found)} of {count} lines, {len(found) / count:.1%} ({limit})")
sys.exit(status)
