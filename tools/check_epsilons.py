#!/usr/bin/env python3
"""Checks that no decision rests on an absolute epsilon. Every small number (below 1/64) and every name like "eps" in shaders
and sources must stand in tools/small_numbers.txt, which says what it is a factor of and where it comes from. The settings of
the cases in report/suite are no decisions and are left out.
Usage: check_epsilons.py [ROOT]; prints file:line of each number without a reason and exits with 1."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
FOLDERS = "include shaders engine swtlas hwtlas renderer samples validation/reference validation/leaks".split()
SUFFIXES = {".h", ".cpp", ".glsl", ".comp", ".rgen", ".rmiss", ".rchit", ".rahit", ".rint", ".vert", ".frag"}
LIMIT = 1 / 64
LITERAL = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F.]+[pP][+-]?\d+|(?:\d+\.\d*|\.\d+|\d+(?=[eE]))(?:[eE][+-]?\d+)?)(?=[fFlL]*\b|[fF]|\W)")
EPSILON = re.compile(r"\b\w*(?:epsilon|(?<![a-zA-Z])eps(?![a-zA-Z]))\w*", re.I)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
TEXT = re.compile(r'R"\((.*?)\)"|"(?:\\.|[^"\\\n])*"', re.S)


def value(literal):
    return float.fromhex(literal) if literal[:2].lower() == "0x" else float(literal)


def blank(match):  # keeps the numbers of lines
    return re.sub(r"[^\n]", " ", match[0])


def small_numbers(file):
    code = COMMENT.sub(blank, TEXT.sub(blank, file.read_text(encoding="utf-8")))
    for number, line in enumerate(code.splitlines(), 1):
        for match in LITERAL.finditer(line):
            if 0 < value(match[1]) < LIMIT:
                yield number, match[1]
        for match in EPSILON.finditer(line):
            yield number, match[0]


# "path literal reason": the same number in the same file has one reason.
allowed, found, used = {}, [], set()
listing = root / "tools/small_numbers.txt"
for number, line in enumerate(listing.read_text(encoding="utf-8").splitlines(), 1):
    if not line.strip() or line.startswith("#"):
        continue
    fields = line.split(None, 2)
    if len(fields) < 3:
        found.append(f"{listing}:{number}: needs a path, a number and a reason")
        continue
    allowed[fields[0], fields[1]] = number
for folder in FOLDERS:
    for file in sorted((root / folder).rglob("*")):
        if file.suffix not in SUFFIXES:
            continue
        path = str(file.relative_to(root))
        for number, literal in small_numbers(file):
            if (path, literal) in allowed:
                used.add((path, literal))
            else:
                found.append(f"{path}:{number}: {literal}: not in {listing.name}; an absolute epsilon?")
found += [f"{listing}:{allowed[key]}: {key[0]} has no {key[1]}" for key in allowed if key not in used]
print("\n".join(found) or f"check_epsilons: {len(used)} small numbers, each with a reason")
sys.exit(1 if found else 0)
