#!/usr/bin/env python3
"""Compiles what a build for Windows compiles, but its tests, as code for MSVC's target, and throws it away: by clang,
with libc++ and the headers of MinGW-w64, since MSVC's are not free. It finds what MSVC is known to refuse: GNU's
extensions, initialisers out of order, headers and names of POSIX. MSVC itself is not run.
Usage: check_msvc.py BUILD [PART OF A NAME]...; LIBCXX names another folder of libc++'s headers than Debian's
Debian: clang-19, libc++-19-dev, g++-mingw-w64-x86-64-posix"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

build, parts = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
clang = ["clang++-19", "--target=x86_64-pc-windows-msvc", "-fsyntax-only", "-std=c++20", "-nostdinc++",
         "-isystem", os.environ.get("LIBCXX", "/usr/lib/llvm-19/include/c++/v1"),
         "-isystem", "/usr/x86_64-w64-mingw32/include",
         # The headers take clang for a compiler that they know; libc++ calls std::jthread an experiment.
         "-D_LIBCPP_NO_VCRUNTIME", "-D_UCRT", "-U_MSC_VER", "-fgnuc-version=12.2.0", "-fexperimental-library",
         "-fno-ms-compatibility", "-Wpedantic", "-Werror=gnu", "-Werror=c99-designator", "-Werror=reorder-init-list",
         "-Werror=vla-extension", "-Wno-pragma-pack"]
LACK = "call to deleted function 'from_chars'"  # of floating-point numbers: libc++ 19 has none, MSVC has
headers = tempfile.TemporaryDirectory()
(pathlib.Path(headers.name) / "Windows.h").write_text("#include <windows.h>\n")  # letters of names count here


def options(entry):
    return re.findall(r"(?:-I|-D|-U|-isystem )\S+", entry["command"].replace("\\\"", "\""))


def errors(source, flags):
    command = [*clang, "-isystem", headers.name, *(word for flag in flags for word in flag.split(" ", 1)), source]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return [line for line in done.stderr.splitlines() if re.search(r"(error|fatal error): ", line) and LACK not in line]


entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
todo = {entry["file"]: options(entry) for entry in entries if re.search(r"\.(cpp|cxx)$", entry["file"])
        and "/tests/" not in entry["file"] and all(part in entry["file"] for part in parts)}
with ThreadPoolExecutor(os.cpu_count()) as pool:
    found = dict(zip(todo, pool.map(errors, todo, todo.values())))
wrong = {source: lines for source, lines in found.items() if lines}
for lines in wrong.values():
    print(*lines[:5], sep="\n")
print(f"check_msvc: {len(todo)} units, {len(wrong)} with errors")
sys.exit(bool(wrong or not todo))
