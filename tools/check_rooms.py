#!/usr/bin/env python3
"""Checks docs/architecture.md against the tree: each folder has its sentence under "## Rooms", and each sentence its
folder; files that sources, pages and figures name exist, and so do functions that figures name.
Usage: check_rooms.py [ROOT]; prints the faults and exits with 1."""
import fnmatch
import os
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
page = root / "docs/architecture.md"
ROW = re.compile(r"\| `([^`]+)/` \| (.*?) *\|$")
SOURCE = re.compile(r"\.(h|cpp|glsl|comp|rgen|rint|rahit|rchit|rmiss|frag|vert)$")
SUFFIXES = r"(?:h|cpp|glsl|comp|rgen|py|sh|md|txt|json)"


def files_of_git():
    if not (root / ".git").exists():
        return []
    command = ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        names = subprocess.run(command, capture_output=True, check=True, text=True).stdout.split("\0")
    except (OSError, subprocess.CalledProcessError):  # no git, or a folder of another user
        return []
    return [name for name in names if name and (root / name).is_file()]


def files_of_walk():
    """Where there is no git: all but what .gitignore names, whose patterns of folders end with a slash or a star."""
    ignored = [line for line in (root / ".gitignore").read_text().split() if line[-1] in "/*"] + [".git/"]

    def is_ignored(name):  # relative to the root
        return any(
            fnmatch.fnmatch(name if "/" in pattern[:-1] else name.rsplit("/", 1)[-1], pattern.strip("/"))
            for pattern in ignored
        )

    files = []
    for folder, below, names in os.walk(root):
        inside = pathlib.Path(folder).relative_to(root)
        below[:] = [name for name in below if not is_ignored((inside / name).as_posix())]
        files += [(pathlib.Path(folder) / name).relative_to(root).as_posix() for name in names]
    return files


def numbered_lines(path):
    return enumerate(path.read_text(encoding="utf-8").splitlines(), 1)


def rows_of_page():
    is_in_section = False
    for number, line in numbered_lines(page):
        if line.startswith("## "):
            is_in_section = line == "## Rooms"
        if is_in_section and (row := ROW.match(line)):
            yield number, row[1], row[2]


files = files_of_git() or files_of_walk()
folders = {parent.as_posix() for name in files for parent in pathlib.PurePosixPath(name).parents} - {"."}
found, told = [], set()
for number, folder, sentence in rows_of_page():
    if folder not in folders:
        found.append(f"{page}:{number}: no such folder, or an empty one: {folder}/")
    if folder in told:
        found.append(f"{page}:{number}: {folder}/ has a sentence already")
    if not sentence:
        found.append(f"{page}:{number}: {folder}/ has no sentence")
    told.add(folder)
found += [f"{page}: no sentence for the folder {folder}/" for folder in sorted(folders - told)]

last_names = {name.rsplit("/", 1)[-1] for name in files}
for number, line in numbered_lines(page):
    for name in re.findall(rf"`([\w./-]+\.{SUFFIXES})`", line):
        if name not in files and not ("/" not in name and name in last_names):
            found.append(f"{page}:{number}: no such file: {name}")

folders_on_top = {name.split("/")[0] for name in files if "/" in name and not name.startswith(".")}
tops = "|".join([*sorted(folders_on_top), "twinray/glsl"])
for name in files:
    if not (SOURCE.search(name) or name.endswith(".md")) or name == "CHANGELOG.md":
        continue
    for number, line in numbered_lines(root / name):
        found += [f"{root / name}:{number}: no such file: {named}"
                  for named in re.findall(rf"(?<![\w/.])((?:{tops})/[\w./-]+\.{SUFFIXES})\b", line)
                  if not any(folder + named in files for folder in ("", "include/", "shaders/"))]

calls = set()
for name in files:
    if SOURCE.search(name) and not name.startswith("tests/"):
        calls.update(re.findall(r"\b(\w+)\(", (root / name).read_text(encoding="utf-8")))
for figure in sorted((root / "docs/figures").glob("*.dot")):
    for number, line in numbered_lines(figure):
        label = line.partition("label=")[2]
        for name in re.findall(rf"[\w/]+\.{SUFFIXES}\b", label):
            if not any(("/" + file).endswith("/" + name) for file in files):
                found.append(f"{figure}:{number}: no such file: {name}")
        found += [f"{figure}:{number}: no such function: {name}()"
                  for name in re.findall(r"\b(\w+)\(\)", label) if name not in calls]

print("\n".join(found) or f"check_rooms: {len(folders)} folders, each with its sentence")
sys.exit(1 if found else 0)
