#!/usr/bin/env python3
"""Puts together what Sphinx reads: the pages of docs/, a few from elsewhere in the tree, and those of the reference.
Links go to pages of the site; those to other files of the tree become their names.
Usage: stage.py FOLDER TWINRAY   FOLDER: is made anew; below its parent are cpp/xml and glsl/xml of Doxygen;
                                 TWINRAY: the command, whose help becomes pages"""

import os
import pathlib
import re
import shutil
import sys

import reference_pages

root = pathlib.Path(__file__).resolve().parents[2]
# Pages that lie elsewhere in the tree, by their names on the site.
ELSEWHERE = {"samples/README.md": "samples.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
             "samples/first_hit.cpp": "first_hit.cpp"}  # fmt: skip
LEFT_OUT = {"docs/conf.py", "docs/site"}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")


def name_on_site(path):
    """Where a file of the tree is on the site; None: it is not there."""
    if path in ELSEWHERE:
        return ELSEWHERE[path]
    if path.startswith("docs/") and (root / path).is_file() and not any(path.startswith(left) for left in LEFT_OUT):
        return path.removeprefix("docs/")
    return None


def relinked(text, path):
    """The text of the page at `path` with links as the site has them."""
    page = name_on_site(path)

    def replaced(match):
        image, label, target = match.groups()
        file, anchor_mark, anchor = target.partition("#")
        if not file or re.match(r"[a-z]+:", target):
            return match[0]
        found = os.path.normpath(os.path.join(os.path.dirname(path), file))
        if not (root / found).exists():
            return match[0]  # Sphinx names it
        name = name_on_site(found)
        if name is None:
            return label
        return f"{image}[{label}]({os.path.relpath(name, os.path.dirname(page) or '.')}{anchor_mark}{anchor})"

    return LINK.sub(replaced, text)


def stage_pages(folder):
    files = [file for file in sorted((root / "docs").rglob("*")) if file.is_file()]
    for path in [file.relative_to(root).as_posix() for file in files] + list(ELSEWHERE):
        name = name_on_site(path)
        if name is None:
            continue
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.endswith(".md"):
            target.write_text(relinked((root / path).read_text(encoding="utf-8"), path), encoding="utf-8")
        else:
            shutil.copyfile(root / path, target)


def main(folder, twinray):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    stage_pages(folder)
    # Pages of tutorials show parts of programs.
    shutil.copytree(root / "samples", folder.parent / "samples", dirs_exist_ok=True)
    reference_pages.write_cpp(folder / "reference/cpp", root / "include/twinray")
    reference_pages.write_glsl(folder / "reference/glsl", folder.parent / "glsl/xml", root / "include/twinray/glsl")
    reference_pages.write_commands(folder / "reference/commands", twinray)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2])
