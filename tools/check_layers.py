#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks who includes whom. Usage: check_layers.py [ROOT]; prints file:line of each violation and exits with 1."""
import os
import re
import sys

BASE = ["engine/core", "engine/scene", "engine/accel", "engine/report"]
ENGINE = BASE + ["engine", "engine/analysis", "engine/collide", "engine/picture", "engine/points", "engine/verify"]
PRODUCT = ENGINE + ["swtlas", "hwtlas"]
SEES = {  # besides itself and shaders/shared
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
GLSL = re.compile(r"\.(glsl|comp|rgen|rmiss|rchit|rahit|rint|rcall|vert|frag)$")  # outside shaders/, sees them all
SOURCE = re.compile(r"\.(h|hpp|c|cc|cpp|inl)$|" + GLSL.pattern)
GENERATED = re.compile(r"\.(spv|trace_program)\.h$|^twinray_program\.glsl$|^twinray/|^twinray_version\.h$|^kernel_modules\.h$|\.py\.h$")  # by the build, or as installed
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] in ("engine", "shaders") and len(parts) > 2 else parts[0]


def violation(root, source, bracket, target):
    exists = os.path.isfile(os.path.join(root, target))
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


root, found = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(__file__) + "/.."), []
for top in sorted({name.split("/")[0] for name in SEES}):
    for folder, _, names in sorted(os.walk(os.path.join(root, top))):
        for source in sorted(os.path.relpath(os.path.join(folder, n), root) for n in names if SOURCE.search(n)):
            if layer(source) not in SEES and not source.startswith("shaders/"):
                found.append(f"{source}:1: the table in tools/check_layers.py has no folder {layer(source)}")
                continue
            with open(os.path.join(root, source), encoding="utf-8") as lines:
                includes = [(number, INCLUDE.match(line)) for number, line in enumerate(lines, 1)]
            reasons = [(n, m[2], violation(root, source, m[1], m[2])) for n, m in includes if m]
            found += [f'{source}:{n}: "{target}": {reason}' for n, target, reason in reasons if reason]
print("\n".join(found) or "check_layers: every include keeps to the table")
sys.exit(1 if found else 0)

