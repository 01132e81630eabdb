#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks who includes whom, and how many headers a host compiles behind the few that it includes.
Usage: check_layers.py [ROOT]; prints file:line of each violation and exits with 1."""
import os
import re
import sys

BASE = ["engine/core", "engine/scene", "engine/accel", "engine/report"]
ENGINE = BASE + ["engine", "engine/analysis", "engine/collide", "engine/picture", "engine/points", "engine/verify"]
PRODUCT = ENGINE + ["swtlas", "hwtlas"]
SEES = {  # besides itself, include/twinray and shaders/shared
    "include": ["engine/core", "engine/scene"],  # until nothing behind it is internal
    "engine": ENGINE,  # headers that gather the others
    "engine/core": [], "engine/scene": BASE[:1], "engine/accel": BASE[:2], "engine/report": BASE[:1],
    "engine/analysis": BASE, "engine/collide": BASE, "engine/picture": BASE, "engine/verify": BASE,
    "engine/points": BASE + ["engine/collide"],
    "swtlas": ENGINE, "hwtlas": ENGINE,
    "validation": PRODUCT + ["shaders/suite", "shaders/path_tracer", "samples"],
    "cli": PRODUCT + ["shaders/path_tracer", "bench", "samples", "validation"],
    "samples": PRODUCT + ["shaders/path_tracer", "shaders/embed_renderer", "shaders/particles"],
    "bench": PRODUCT, "tests": PRODUCT + ["cli", "samples", "bench", "validation"],
    "shaders/embed_renderer": ["shaders/path_tracer"],
    "shaders/twinray": ["shaders/hwtlas"],  # what users include
    "shaders": ["shaders/engine"],  # each other folder of shaders, but shaders/shared, which sees nothing else
}
MOST_HEADERS = {  # of this project behind a public one, directly or not; lower them whenever they fall
    "engine/accel/abstract_accel.h": 57, "hwtlas/hw_tlas.h": 67, "swtlas/sw_tlas.h": 90,
}
GLSL = re.compile(r"\.(glsl|comp|rgen|rmiss|rchit|rahit|rint|rcall|vert|frag)$")  # outside shaders/, sees them all
SOURCE = re.compile(r"\.(h|hpp|c|cc|cpp|inl)$|" + GLSL.pattern)
GENERATED = re.compile(r"\.(spv|trace_program)\.h$|^twinray_program\.glsl$|^twinray/|^twinray_version\.h$|^kernel_modules\.h$|\.py\.h$")  # by the build, or as installed
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] in ("engine", "shaders") and len(parts) > 2 else parts[0]


def violation(root, source, bracket, target):
    exists = os.path.isfile(os.path.join(root, target))
    if bracket == "<" and target.startswith("twinray/"):
        return None if os.path.isfile(os.path.join(root, "include", target)) else "no such public header"
    if bracket == "<":
        return "a file of this project is included with quotes" if exists else None
    if GENERATED.search(target):
        return None
    if not exists or ".." in target.split("/"):
        return "no such file; includes are written from the root, those of other projects in <>"
    origin, seen = layer(source), layer(target)
    kernels_of_others = GLSL.search(source) and not origin.startswith("shaders/") and seen.startswith("shaders/")
    sees = [] if origin == "shaders/shared" else SEES[origin if origin in SEES else "shaders"]
    if seen in [origin, "shaders/shared"] + sees or kernels_of_others:
        return None
    return f"{origin} must not see {seen}"


def includes_of(root, source):
    with open(os.path.join(root, source), encoding="utf-8") as lines:
        return [(number, m[1], m[2]) for number, line in enumerate(lines, 1) if (m := INCLUDE.match(line))]


def headers_behind(root, header):
    behind, to_read = set(), [header]
    while to_read:
        targets = {target if bracket == '"' else f"include/{target}"
                   for _, bracket, target in includes_of(root, to_read.pop())}
        new = {target for target in targets - behind - {header} if os.path.isfile(os.path.join(root, target))}
        behind |= new
        to_read += new
    return behind


root, found = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(__file__) + "/.."), []
for top in sorted({name.split("/")[0] for name in SEES}):
    for folder, _, names in sorted(os.walk(os.path.join(root, top))):
        for source in sorted(os.path.relpath(os.path.join(folder, n), root) for n in names if SOURCE.search(n)):
            if layer(source) not in SEES and not source.startswith("shaders/"):
                found.append(f"{source}:1: the table in tools/check_layers.py has no folder {layer(source)}")
                continue
            reasons = [(n, target, violation(root, source, bracket, target))
                       for n, bracket, target in includes_of(root, source)]
            found += [f'{source}:{n}: "{target}": {reason}' for n, target, reason in reasons if reason]
counts = {header: len(headers_behind(root, header)) for header in MOST_HEADERS}
found += [f"{header}:1: {counts[header]} headers of this project behind it, at most {most}"
          for header, most in MOST_HEADERS.items() if counts[header] > most]
behind = ", ".join(f"{count} headers behind {header}" for header, count in counts.items())
print("\n".join(found) or f"check_layers: every include keeps to the table; {behind}")
sys.exit(1 if found else 0)

