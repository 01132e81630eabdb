#!/usr/bin/env python3
"""A figure of lavapipe names the Mesa that gave it. Usage: driver_versions_test.py SOURCE_DIR

lavapipe changes much from one Mesa to the next: README.md and the pages of docs/ say of each measured figure which one.
Looked at are paragraphs, single items of lists and single rows of tables in which lavapipe and a figure with a unit
stand. A page whose first paragraph names a Mesa says it for all of the page.
"""

import re
import sys
from pathlib import Path

FIGURE = re.compile(r"\d(?:[\d.,]*\d)?\s?(?:%|ms\b|s\b|times\b|rays\b|Mrays|ulp\b|million\b|roundings\b)")
VERSION = re.compile(r"(?:Mesa |\b)2[4-9]\.\d")


def pieces(text: str):
    """Paragraphs, items and rows, each with the number of its first line; what fences hold is left out."""
    fenced = False
    block: list[str] = []
    first = 0
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.startswith("```"):
            fenced = not fenced
        if fenced or line.startswith("```") or not line.strip() or line.startswith(("|", "- ")):
            if block:
                yield first, " ".join(block)
            block = []
            if line.startswith("|") and not fenced:
                yield number, line
            elif line.startswith("- ") and not fenced:
                block, first = [line], number
        else:
            if not block:
                first = number
            block.append(line)


def lacks_version(piece: str) -> bool:
    return "lavapipe" in piece and bool(FIGURE.search(piece)) and not VERSION.search(piece)


def main() -> None:
    assert lacks_version("lavapipe loses 4.6 % of rays at vertices")
    assert not lacks_version("lavapipe of Mesa 25.0.7 loses 4.6 % of rays at vertices")
    assert not lacks_version("lavapipe is Mesa's driver for CPUs")
    root = Path(sys.argv[1])
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    assert len(pages) > 50, pages
    found = [
        f"{page.relative_to(root)}:{number}: {piece[:160]}"
        for page in pages
        if not VERSION.search(" ".join(page.read_text().split("\n\n")[:2]))
        for number, piece in pieces(page.read_text())
        if lacks_version(piece)
    ]
    assert not found, "figures of lavapipe without its version:\n" + "\n".join(found)


if __name__ == "__main__":
    main()
