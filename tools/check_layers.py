#!/usr/bin/env python3
"""Checks who includes whom, that code of one system is in its place, the size of the public interface in include/, and
how much of the project is behind a header.
Usage: check_layers.py [ROOT]; prints file:line of each violation and exits with 1."""
import collections
import os
import re
import sys

BASE = ["engine/core", "engine/scene", "engine/accel"]
ENGINE = BASE + ["engine/analysis", "engine/collide", "engine/points"]
PRODUCT = ENGINE + ["swtlas", "hwtlas"]
VALIDATION = ["validation/" + room for room in ("reference", "leaks", "records", "verify", "cpu_reference")]
REPORT = ["report/" + room for room in "conformance explain faults frame page replay reproducer suite".split()]
CHECKS = VALIDATION + ["validation/exact"] + REPORT
# These see include alone.
AS_HOSTS = ["samples", "samples/support", "renderer", "bindings", "shaders/path_tracer", "shaders/particles"]
# These are also built alone: a header lies beside what includes it. One shows the structs of the engine.
TUTORIALS, INSIDE = "samples/tutorials/", "samples/tutorials/10_inside_the_builder/"
SEES = {  # besides itself, include and, unless AS_HOSTS, shaders/shared
    "include": ["shaders/hwtlas"],  # the public face; its GLSL has parts there and in shaders/shared
    "engine/core": [], "engine/scene": BASE[:1] + ["shaders/scene"], "engine/accel": BASE[:2],
    "engine/analysis": BASE + ["shaders/analysis"], "engine/collide": BASE + ["shaders/collide"],
    "engine/points": BASE + ["engine/collide", "shaders/points"],
    "swtlas": ENGINE, "hwtlas": ENGINE,
    "validation/reference": BASE + ["shaders/verify"], "validation/leaks": BASE + VALIDATION[:1],
    "validation/records": BASE + VALIDATION[:1], "validation/verify": PRODUCT + VALIDATION,
    "validation/cpu_reference": ENGINE + ["swtlas"], "validation/exact": BASE + VALIDATION[:1],
    "report/frame": PRODUCT + VALIDATION,
    "report/conformance": PRODUCT + VALIDATION + ["report/frame", "shaders/conformance", "samples/support"],
    "report/suite": PRODUCT + CHECKS + ["shaders/suite", "shaders/collide", "renderer", "samples/support"],
    "report/replay": PRODUCT + VALIDATION, "report/explain": PRODUCT + CHECKS, "report/page": BASE + CHECKS,
    "report/reproducer": PRODUCT + CHECKS,
    "report/faults": BASE,
    "renderer": ["shaders/path_tracer", "samples/support"], "samples/support": [],
    "viewer": PRODUCT + CHECKS + ["viewer/picture", "renderer"], "viewer/picture": BASE,
    "cli": PRODUCT + CHECKS + ["bench", "viewer", "viewer/picture", "renderer", "samples/support"],
    "bindings": [],
    "samples": ["shaders/particles", "renderer", "samples/support"],
    "bench": PRODUCT + VALIDATION + ["samples/support"],
    "tests": PRODUCT + CHECKS + ["cli", "samples", "samples/support", "renderer", "bench", "viewer",
                                 "viewer/picture"],
    "shaders/path_tracer": [], "shaders/particles": [],
    "shaders/points": ["shaders/collide", "shaders/engine"],
    # Each other folder of shaders, but shaders/shared, which sees nothing else.
    "shaders": ["shaders/engine", "shaders/scene"],
}
# Code of one system, which needs nothing of twinray, so that programs that see include alone may also use it.
PLATFORM, PLATFORM_READERS = "engine/core/platform.h", ("renderer", "samples", "samples/support")
# Everything else is compiled for every system. Python's package is for Linux; the other files are left out elsewhere
# by CMake, or are programs of their own.
OF_SYSTEMS = ("engine/core/platform/", "bindings/", "tests/core/processes_test.cpp", "tests/fuzz/contract.cpp",
              "tests/fuzz/replay.cpp", "tests/python/", "tests/report/reproducer/write_test.cpp",
              "tests/support/broken_driver/", "tests/support/leaks_of_others.cpp")
SYSTEM = re.compile(r"\b(_?WIN(32|64)|_MSC_VER|__MINGW(32|64)__|__CYGWIN__|__linux(__)?|__unix(__)?|__APPLE__|__FreeBSD__|"
                    r"__GLIBC__|_POSIX_\w+)\b|#\s*include\s*<(arpa/\w+|direct|dirent|dlfcn|fcntl|glob|io|netdb|netinet/\w+|"
                    r"poll|process|psapi|pthread|pwd|sched|shellapi|shlobj|spawn|sys/\w+|termios|unistd|windows|winsock2|"
                    r"ws2tcpip)\.h>")
MOST_HEADERS = {  # of this project behind a header, directly or not; lower them whenever they fall
    "include/twinray/tlas.h": 12, "engine/accel/accel_backend.h": 35,
}
MOST_PUBLIC = {"headers": 15, "lines": 3739}  # of include/twinray, its GLSL apart
MOST_LINES = {"include/twinray/abstract_accel.h": 270}
MOST_LONELY = 11  # private headers that one file reads, beside their own .cpp; lower it whenever it falls
# These files bring meshes of the host to the device: the store, and a host of twinray, which the path tracer is.
UPLOADING = {"engine/accel/mesh_store.cpp", "renderer/scene_upload.cpp"}
OF_MESHES = ("engine/accel/", "engine/analysis/", "engine/collide/", "engine/points/", "swtlas/", "hwtlas/",
             "renderer/")
UPLOAD = re.compile(r"\b(?:upload|stage|put)\(.*\bpositions\b")
GLSL = re.compile(r"\.(glsl|comp|rgen|rmiss|rchit|rahit|rint|rcall|vert|frag)$")  # outside shaders/, sees them all
SOURCE = re.compile(r"\.(h|hpp|c|cc|cpp|inl)$|" + GLSL.pattern)
GENERATED = re.compile(  # by the build, or as installed
    r"\.(spv|trace_program)\.h$|^twinray_program\.glsl$|^twinray_version\.h$|^kernel_modules\.h$|\.(py|c|gltf|json)\.h$"
)
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def file_of(root, target):
    """The file that an include names: <twinray/...>, and its GLSL in quotes, lie in include/."""
    return "include/" + target if target.startswith("twinray/") else target


def layer(path):
    parts = path.split("/")
    room = "/".join(parts[:2])
    has_rooms = parts[0] in ("engine", "shaders", "validation", "report")
    return room if len(parts) > 2 and (has_rooms or room in SEES) else parts[0]


def violation(root, source, bracket, target):
    file = file_of(root, target)
    exists = os.path.isfile(os.path.join(root, file))
    if bracket == "<" and not file.startswith("include/"):
        return "a file of this project is included with quotes" if exists else None
    is_beside = os.path.isfile(os.path.join(root, os.path.dirname(source), target))
    if GENERATED.search(target) or (source.startswith(TUTORIALS) and "/" not in target and is_beside):
        return None
    if not exists or ".." in target.split("/"):
        return "no such file; includes are written from the root, those of other projects in <>"
    origin, seen = layer(source), layer(file)
    kernels_of_others = GLSL.search(source) and not origin.startswith("shaders/") and seen.startswith("shaders/")
    sees = [] if origin == "shaders/shared" else SEES[origin if origin in SEES else "shaders"]
    if file == PLATFORM and origin in PLATFORM_READERS:
        return None
    shared = [] if origin in AS_HOSTS and not source.startswith(INSIDE) else ["shaders/shared"]
    if seen in [origin, "include"] + shared + sees or kernels_of_others:
        return None
    return f"{origin} must not see {seen}"


def includes_of(root, source):
    with open(os.path.join(root, source), encoding="utf-8") as lines:
        return [(number, m[1], m[2]) for number, line in enumerate(lines, 1) if (m := INCLUDE.match(line))]


def lines_with(pattern, root, source):
    with open(os.path.join(root, source), encoding="utf-8") as lines:
        return [number for number, line in enumerate(lines, 1) if pattern.search(line)]


def headers_behind(root, header):
    behind, to_read = set(), [header]
    while to_read:
        targets = {file_of(root, target) for _, _, target in includes_of(root, to_read.pop())}
        new = {target for target in targets - behind - {header} if os.path.isfile(os.path.join(root, target))}
        behind |= new
        to_read += new
    return behind


def lines_of(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as lines:
        return sum(1 for _ in lines)


def resolved(root, source, target):
    """The file of this project that an include names, or None."""
    beside = os.path.join(os.path.dirname(source), target)
    return next((file for file in (file_of(root, target), beside) if os.path.isfile(os.path.join(root, file))), None)


root, found = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(__file__) + "/.."), []
readers, seen_by_room = collections.defaultdict(set), set()
for top in sorted({name.split("/")[0] for name in SEES}):
    for folder, _, names in sorted(os.walk(os.path.join(root, top))):
        for source in sorted(os.path.relpath(os.path.join(folder, n), root) for n in names if SOURCE.search(n)):
            if layer(source) not in SEES and not source.startswith("shaders/"):
                found.append(f"{source}:1: the table in tools/check_layers.py has no folder {layer(source)}")
                continue
            reasons = [(n, target, violation(root, source, bracket, target))
                       for n, bracket, target in includes_of(root, source)]
            found += [f'{source}:{n}: "{target}": {reason}' for n, target, reason in reasons if reason]
            if not source.startswith(OF_SYSTEMS):
                found += [f"{source}:{n}: code of one system belongs into engine/core/platform/"
                          for n in lines_with(SYSTEM, root, source)]
            if source.startswith(OF_MESHES) and source not in UPLOADING:
                found += [f"{source}:{n}: meshes go to the device by engine/accel/mesh_store.h"
                          for n in lines_with(UPLOAD, root, source)]
            for file in filter(None, (resolved(root, source, target) for _, _, target in includes_of(root, source))):
                readers[file].add(source)
                seen_by_room.add((layer(source), layer(file)))
# GLSL of the public face has parts in shaders/.
found += [f"{a}: {a} and {b} include each other" for a, b in sorted(seen_by_room)
          if a < b and (b, a) in seen_by_room and a != "include"]
lonely = sorted(file for file, who in readers.items() if file.endswith(".h") and len(who - {file[:-2] + ".cpp"}) <= 1
                and not file.startswith(("include/", "tests/")))
if len(lonely) > MOST_LONELY:
    found.append(f"{len(lonely)} private headers have one reader, at most {MOST_LONELY}: " + ", ".join(lonely))
counts = {header: len(headers_behind(root, header)) for header in MOST_HEADERS}
found += [f"{header}:1: {counts[header]} headers of this project behind it, at most {most}"
          for header, most in MOST_HEADERS.items() if counts[header] > most]
face = [f"include/twinray/{name}" for name in sorted(os.listdir(os.path.join(root, "include/twinray"))) if name.endswith(".h")]
size = {"headers": len(face), "lines": sum(lines_of(root, header) for header in face)}
found += [f"include/twinray:1: {size[what]} {what}, at most {most}" for what, most in MOST_PUBLIC.items() if size[what] > most]
found += [f"{header}:1: {lines_of(root, header)} lines, at most {most}"
          for header, most in MOST_LINES.items() if lines_of(root, header) > most]
behind = "; ".join((
    f"{len(lonely)} private headers with one reader",
    f"a public face of {size['headers']} headers and {size['lines']} lines",
    ", ".join(f"{count} headers behind {header}" for header, count in counts.items()),
))
print("\n".join(found) or f"check_layers: every include keeps to the table; {behind}")
sys.exit(1 if found else 0)

