#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs what the README and the pages of docs/ show, or finds in its fence why not: blocks.py says how blocks tell.
Usage: code_blocks.py --programs FOLDER --package FOLDER [--root FOLDER] [--check-only] [PAGE...]
  --programs   where twinray and path_tracer are        --package      where the Python package is
  --python     which Python runs blocks; it has what the package needs
  --check-only info strings alone: nothing is run"""

import argparse
import pathlib
import sys
import tempfile
import time

try:
    import blocks
except ModuleNotFoundError as error:
    print(f"{error}: tools/docs.sh installs it into build/docs/venv")
    sys.exit(77)
import given
import run_block

ELSEWHERE = ["README.md", "CONTRIBUTING.md", "samples/README.md"]  # also on the site


def pages_of(root):
    return [*ELSEWHERE, *sorted(page.relative_to(root).as_posix() for page in (root / "docs").rglob("*.md"))]


def faults_of_page(root, page):
    found = blocks.blocks_of((root / page).read_text(encoding="utf-8"))
    return [f"{page}:{block.line}: {block.fault}" for block in found if block.fault]


def blocks_to_run(root, page):
    return [block for block in blocks.blocks_of((root / page).read_text(encoding="utf-8")) if block.is_run]


def run_page(tools, page, folder):
    faults, count = [], 0
    folder.mkdir()
    given.write(folder)
    for block in blocks_to_run(tools.root, page):
        if not run_block.can_run(block, folder, tools):
            print(f"{page}:{block.line}: not run: no {block.options['needs']} is here")
            continue
        count += 1
        fault = run_block.WAYS[block.language](block, folder, tools)
        if fault:
            faults.append(f"{page}:{block.line}: {fault}")
    return faults, count


def run_pages(tools, pages):
    """What is wrong, and how many blocks were run. Each page has a folder."""
    faults, total = [], 0
    with tempfile.TemporaryDirectory() as above:
        for number, page in enumerate(pages):
            begin = time.monotonic()
            found, count = run_page(tools, page, pathlib.Path(above) / str(number))
            faults += found
            total += count
            if count:
                print(f"{page}: {count} blocks, {len(found)} faults, {time.monotonic() - begin:.1f} s", flush=True)
    return faults, total


def main(arguments):
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=pathlib.Path)
    parser.add_argument("--package", type=pathlib.Path)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--root", type=pathlib.Path, default=here.parents[1])
    parser.add_argument("--check-only", action="store_true")
    parser.add_argument("pages", nargs="*")
    tools = parser.parse_args(arguments)
    tools.wraps, tools.printed, tools.found = here / "wraps", {}, {}
    pages = tools.pages or pages_of(tools.root)
    faults = []
    for page in pages:
        faults += faults_of_page(tools.root, page)
    found, total = ([], 0) if tools.check_only else run_pages(tools, pages)
    faults += found
    for fault in faults:
        print(fault)
    print(f"code_blocks: {len(pages)} pages, {total} blocks run, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
