#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads each source of a build for Windows as code for MSVC's target: by clang, with libc++ and the headers of MinGW-w64,
since those of MSVC are not free. It finds what MSVC's compiler is known to refuse: extensions of GNU, initialisers out of
order, headers and names of POSIX, headers that another standard library includes by chance. No code of MSVC runs.
Usage: check_msvc.py BUILD [PART OF A NAME]... (Debian: clang-19, libc++-19-dev; LIBCXX names another folder of headers)"""
import json
import os
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

root = pathlib.Path(__file__).resolve().parent.parent
build, parts = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
clang = ["clang++-19", "--target=x86_64-pc-windows-msvc", "-fsyntax-only", "-std=c++20", "-nostdinc++",
         "-isystem", os.environ.get("LIBCXX", "/usr/lib/llvm-19/include/c++/v1"),
         "-isystem", "/usr/x86_64-w64-mingw32/include",
         # Both libraries take clang for what they know then.
         "-D_LIBCPP_NO_VCRUNTIME", "-D_UCRT", "-U_MSC_VER", "-fgnuc-version=12.2.0",
         "-fno-ms-compatibility", "-Wpedantic", "-Werror=gnu", "-Werror=c99-designator", "-Werror=reorder-init-list",
         "-Werror=vla-extension", "-Wno-pragma-pack"]


def sources(entry):
    """A unity file names its sources."""
    file = pathlib.Path(entry["file"])
    if "Unity" not in file.parts:
        return [file]
    return [pathlib.Path(name) for name in re.findall(r'^#include "(.+)"$', file.read_text(encoding="utf-8"), re.M)]


def options(entry):
    return re.findall(r"(?:-I|-D|-isystem )\S+", entry["command"].replace("\\\"", "\""))


def errors(source, flags):
    command = [*clang, *(word for flag in flags for word in flag.split(" ", 1)), str(source)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return [line for line in done.stderr.splitlines() if re.search(r"(error|fatal error): ", line)]


entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
todo = {source: options(entry) for entry in entries for source in sources(entry)
        if source.suffix == ".cpp" and source.is_relative_to(root) and not source.is_relative_to(build)
        and all(part in str(source) for part in parts)}
with ThreadPoolExecutor(os.cpu_count()) as pool:
    found = dict(zip(todo, pool.map(errors, todo, todo.values())))
wrong = {source: lines for source, lines in found.items() if lines}
for lines in wrong.values():
    print(*lines[:5], sep="\n")
print(f"check_msvc: {len(todo)} sources, {len(wrong)} with errors")
sys.exit(bool(wrong or not todo))
