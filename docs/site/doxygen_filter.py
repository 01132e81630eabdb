#!/usr/bin/env python3
"""Doxygen's input filter: prints a header with its `//` comments in the form that Doxygen reads.
A comment before a declaration becomes `///`, one behind it `///<`, the comment on top that of the file. Overloads
that follow a function without a blank line share its comment, and so do aliases. The namespace twinray is left out, so
that a page of the reference, which is a header, has the names themselves and not once more the namespace.
Usage: doxygen_filter.py FILE"""

import pathlib
import re
import sys

COMMENT = re.compile(r"^\s*// ?(.*)$")
RULE = re.compile(r"-{8,}\s*$")  # ends the title of a section, which is no declaration's
BEHIND = re.compile(r"^(.*\S)\s+// (.*)$")
FUNCTION = re.compile(r"^[^(=]*?(operator\S+?|~?\w+)\s*\(")
NAMESPACE = re.compile(r"^(namespace twinray \{|\}\s*// namespace twinray)$")
SCOPE = re.compile(r"^\s*((template\b.*>\s*)?(class|struct|union|enum|namespace|extern|STRUCT)\b.*\{|\}.*|\w+:)$")


def escaped(text):
    return re.sub(r"`(\w+)`", r"\\c \1", re.sub(r'([\\@<>&#%"])', r"\\\1", text))


def doxygen_lines(texts):
    """The lines of a comment: what is indented by four becomes code."""
    is_code = False
    for text in texts:
        if text.startswith("    ") and not is_code:
            yield "\\code{.cpp}"
            is_code = True
        if is_code and text.strip() and not text.startswith("    "):
            yield "\\endcode"
            is_code = False
        yield text[4:] if is_code else escaped(text)
    if is_code:
        yield "\\endcode"


def comment_of_file(name, lines):
    """How many lines the comment on top has, and what it becomes."""
    count = next((i for i, line in enumerate(lines) if not COMMENT.match(line)), len(lines))
    texts = [COMMENT.match(line)[1] for line in lines[:count] if "SPDX" not in line]
    return count, [f"\\file {name}", *doxygen_lines(texts)]


def name_declared(line, next_line):
    """Of a function, or `using` of any alias; what `template <...>` on a line of its own belongs to is below it."""
    if line.lstrip().startswith("using "):
        return "using"
    function = FUNCTION.match(next_line if re.match(r"\s*template <.*>$", line) else line)
    return function[1] if function else ""


def filtered(name, source):
    lines = [line for line in source.split("\n") if not NAMESPACE.match(line)]
    count, head = comment_of_file(name, lines)
    yield from (f"/// {text}" for text in head)
    comment, last_name, last_comment = [], "", []
    depth = 0  # of brackets that are open within a declaration
    begins = True  # whether the next line begins one
    for position, line in enumerate(lines[count:], count + 1):
        if depth == 0 and (match := COMMENT.match(line)):
            comment.append(match[1])
            continue
        if not line.strip():
            comment, last_name = [], ""
            yield line
            continue
        behind = BEHIND.match(line)
        code = behind[1] if behind else line
        bare = re.sub(r'"[^"]*"|\'.\'', "", code)
        if begins or (depth == 0 and bare.lstrip().startswith("#")):  # a macro that stands alone has no semicolon
            function_name = name_declared(bare, lines[position] if position < len(lines) else "")
            if not comment and not behind and function_name and function_name == last_name:
                comment = last_comment
            last_name, last_comment = function_name, comment or ([behind[2]] if behind else [])
            if comment and not RULE.search(comment[0]):
                yield from (f"/// {text}" for text in doxygen_lines(comment))
            comment = []
        keeps_behind = behind and depth == 0 and not re.search(r"^\s*#|[{(\\]$", code)
        yield code + (f" ///< {escaped(behind[2])}" if keeps_behind else "")
        if SCOPE.match(bare) and depth == 0:
            depth, begins, last_name = 0, True, ""
            continue
        depth = max(0, depth + sum(bare.count(c) for c in "({") - sum(bare.count(c) for c in ")}"))
        # `template <...>` on a line of its own belongs to what follows.
        begins = depth == 0 and (bool(re.search(r"[;,}]$", bare)) or bare.lstrip().startswith("#"))


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    print("\n".join(filtered(path.name, path.read_text(encoding="utf-8"))))
