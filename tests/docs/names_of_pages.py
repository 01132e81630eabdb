#!/usr/bin/env python3
"""Names that pages give in code font exist: commands and options, members of types, and what tables of calls of
other libraries have in the column of twinray. Commands of blocks that are not run are looked at, too.
Usage: names_of_pages.py --programs FOLDER [PAGE...]"""

import argparse
import collections
import functools
import pathlib
import re
import subprocess
import sys

import code_blocks

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("twinray", "path_tracer", "particles")
OF_OTHERS = {"--fix", "--eliminate-dead-branches", "--freeze-spec-const", "--merge-return"}  # tools/lint.sh, spirv-opt
FOLDERS_OF_TYPES = "include engine swtlas hwtlas validation report renderer samples cli viewer bench".split()
SOURCES = {".h", ".cpp"}
TYPE = re.compile(r"\b(?:struct|class|namespace) ([A-Z]\w*)")
SPAN = re.compile(r"`([^`]+)`")
OPTION = re.compile(r"(?<![\w-])--?[a-z][\w-]*")
MEMBER = re.compile(r"(?<![\w:])([A-Z]\w*)::(\w+)")
# The names in a cell: functions, types, and whole spans.
NAME = re.compile(r"\b(\w+)(?=\()|\b([A-Z]\w*[a-z]\w*)\b|^(\w+)$")


# The least that all pages must have: with fewer, something of theirs is no longer recognised.
LEAST = {"commands": 125, "options": 170, "members": 95, "cells": 70}
looked_at = collections.Counter()


class Public:
    """The public headers and the Python package, as text without comments."""

    def __init__(self, root):
        files = [*(root / "include/twinray").rglob("*.*"), *(root / "bindings/python").rglob("*.py")]
        text = "\n".join(file.read_text(encoding="utf-8") for file in files)
        self.text = re.sub(r"(?<!:)//.*|^ *#(?! *define).*", "", text, flags=re.M)  # URLs stay
        self.words = set(re.findall(r"\w+", self.text))
        inside = [
            file for folder in FOLDERS_OF_TYPES for file in (root / folder).rglob("*.*") if file.suffix in SOURCES
        ]
        self.types = {name for file in inside for name in TYPE.findall(file.read_text(encoding="utf-8"))}

    @functools.lru_cache(maxsize=None)
    def bodies(self, name):
        """The text between the braces of each type of this name."""
        found = []
        for head in re.finditer(rf"\b(?:struct|class|enum class|TWINRAY_\w+) {name}\b[^;{{()]*{{", self.text):
            depth, end = 1, head.end()
            while depth and end < len(self.text):
                depth += {"{": 1, "}": -1}.get(self.text[end], 0)
                end += 1
            found.append(self.text[head.end() : end])
        return found

    def has_member(self, name, member):
        """Types that are not public have what they like, but must be there."""
        looked_at["members"] += 1
        bodies = self.bodies(name)
        return any(re.search(rf"\b{member}\b", body) for body in bodies) or not bodies and name in self.types


class Programs:
    """What the programs' help says of options."""

    def __init__(self, folder):
        self.folder = folder

    @functools.lru_cache(maxsize=None)
    def options(self, program, command):
        """The options of a program, or of one of its commands; None where there is no such command."""
        asked = ["help", command] if program == "twinray" else [command, "--help"] if command else ["--help"]
        done = subprocess.run([self.folder / program, *asked], capture_output=True, text=True, check=False)
        return None if done.returncode else set(OPTION.findall(done.stdout))

    @functools.cached_property
    def all_options(self):
        overview = subprocess.run([self.folder / "twinray", "help"], capture_output=True, text=True, check=True).stdout
        commands = [("twinray", name) for name in re.findall(r"^    ([a-z]+)  +\S", overview, re.M)]
        samples = [(program, "") for program in PROGRAMS[1:]]
        return OF_OTHERS.union(*[self.options(*one) for one in commands + samples])

    def fault_of_span(self, span):
        if span.startswith("--"):
            looked_at["options"] += 1
            wrong = [option for option in OPTION.findall(span) if option not in self.all_options]
            return f"no program has an option {wrong[0]}" if wrong else ""
        return next(filter(None, map(self.fault, commands_of(span))), "")

    def fault(self, words):
        """What is wrong with a command as pages write them, with dots, brackets and names for what may stand there."""
        looked_at["commands"] += 1
        program, *rest = words
        has_command = rest and re.fullmatch(r"[a-z]+", rest[0]) and (program == "twinray" or rest[0] == "merge")
        if rest[:1] == ["help"] or program == "twinray" and not has_command:
            return ""
        name = f"{program} {rest[0]}" if has_command else program
        options = self.options(program, rest[0] if has_command else "")
        if options is None:
            return f"no command '{name}'"
        wrong = [option for option in OPTION.findall(" ".join(rest)) if option not in options]
        return f"'{name}' has no option {wrong[0]}" if wrong else ""


def commands_of(text):
    """The commands in a span or a block, each as its words, up to what a shell makes of them."""
    for line in text.replace("\\\n", " ").splitlines():
        command = re.split(r" #| [|<>;]|&&", line)[0].split()
        while command and "=" in command[0]:  # a variable
            command.pop(0)
        if command and pathlib.PurePath(command[0]).name in PROGRAMS:
            yield [pathlib.PurePath(command[0]).name, *command[1:]]


def cells_of_twinray(text):
    """(line, cell) of the columns that are headed by twinray."""
    column = None
    for number, line in enumerate(text.splitlines(), 1):
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if "twinray" in cells:
            column = cells.index("twinray")
        elif not cells:
            column = None
        elif column is not None and column < len(cells):
            yield number, cells[column]


def faults_of(page, text, public, programs):
    faults = []
    plain = re.sub(r"^```.*?^```", lambda fence: "\n" * fence[0].count("\n"), text, flags=re.M | re.S)
    for number, line in enumerate(plain.splitlines(), 1):
        for span in SPAN.findall(line):
            if fault := programs.fault_of_span(span):
                faults.append((number, fault))
            for name, member in MEMBER.findall(span):
                if not public.has_member(name, member):
                    faults.append((number, f"`{span}`: {name} has no {member}"))
    for number, cell in cells_of_twinray(plain):
        looked_at["cells"] += 1
        names = {name for span in SPAN.findall(cell) for match in NAME.findall(span) for name in match if name}
        faults += [(number, f"no {name} in headers or package") for name in sorted(names - public.words)]
    for block in code_blocks.blocks_of(text):
        if "not-run" in block.options and block.language == "sh":
            faults += [(block.line, fault) for fault in map(programs.fault, commands_of(block.text)) if fault]
    return [f"{page}:{number}: {fault}" for number, fault in faults]


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("pages", nargs="*")
    given = parser.parse_args(arguments)
    public, programs = Public(ROOT), Programs(given.programs)
    pages = given.pages or code_blocks.pages_of(ROOT)
    faults = []
    for page in pages:
        faults += faults_of(page, (ROOT / page).read_text(encoding="utf-8"), public, programs)
    if not given.pages:
        faults += [
            f"only {looked_at[what]} {what}, not {least}" for what, least in LEAST.items() if looked_at[what] < least
        ]
    print("\n".join([*faults, f"names_of_pages: {len(pages)} pages, {dict(looked_at)}, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
