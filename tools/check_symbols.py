#!/usr/bin/env python3
"""Checks the symbols of the libraries.

Usage: check_symbols.py ours LIBRARY.a|LIBRARY.so...
         fails if a library makes anything global that is not of namespace twinray, or a weak function. Else it would
         clash with a host that has its own Vulkan loader, volk, Vulkan Memory Allocator, stb or tinygltf, and an inline
         function that the host compiled with other options could replace twinray's.
       check_symbols.py seen FOLDER NAME=SEEN,...    with FOLDER/twinray_NAME.o of each
         each library asks for symbols of those alone that it is declared to see, or a host that links no more cannot
         link it.
       check_symbols.py public [--record] HEADERS LIST LIBRARY.so...
         compares the functions that the public headers declare and the shared libraries hold with a committed list:
         what programs link against changes on purpose alone. Prints what came and went, or writes the list anew."""
import pathlib
import re
import subprocess
import sys

INTERNAL = re.compile(r"::State::|Backend|\(anonymous namespace\)")
OURS = re.compile(r"[TDBR] _ZNK?7twinray|[TDBRV] _ZT[ISTV]N7twinray")


def nm(file, *options):
    return subprocess.check_output(["nm", *options, file], text=True).splitlines()


def check_ours(*libraries):
    wrong = 0
    for library in libraries:
        table = "--extern-only" if library.endswith(".a") else "--dynamic"
        lines = nm(library, table, "--defined-only", "--no-demangle")
        symbols = [line.split(" ", 1)[1] for line in lines if re.match(r"[0-9a-f]+ ", line)]
        if clashes := [symbol for symbol in symbols if not OURS.match(symbol)]:
            print(subprocess.check_output(["c++filt"], input="\n".join(clashes), text=True))
            print(f"check_symbols: the symbols above are global in {library} and should not be")
        else:
            told = f"all {len(symbols)} symbols of {library} are of namespace twinray, and none is inline"
            print(f"check_symbols: {told}")
        wrong += bool(clashes or not symbols)
    return wrong


def check_seen(folder, *arguments):
    declared = dict(argument.split("=") for argument in arguments)

    def names(name, *options):
        return set(nm(f"{folder}/twinray_{name}.o", "--format=just-symbols", *options))

    def seen_by(name):
        direct = [other for other in declared[name].split(",") if other]
        return {name, *direct}.union(*(seen_by(other) for other in direct))

    defined = {name: names(name, "--defined-only", "--extern-only") for name in declared}
    wrong = [
        f"twinray::{name} asks for {symbol} of twinray::{other}, which it is not declared to see"
        for name in declared for other in set(declared) - seen_by(name)
        for symbol in sorted(names(name, "--undefined-only") & defined[other])
    ]
    print("\n".join([*wrong, f"check_symbols: {len(declared)} libraries, {len(wrong)} symbols of others"]))
    return wrong


def declared_in(headers):
    """The names of types and functions in namespace twinray."""
    text = "".join(header.read_text() for header in sorted(pathlib.Path(headers).glob("*.h")))
    text = re.sub(r"//.*", "", text)
    types = re.findall(r"^(?:class|struct) (\w+)(?: final)?(?: :[^{;]*)? \{", text, re.M)
    functions = re.findall(r"^[\w:<>,&* ]+[ &*](\w+)\(", text, re.M)
    return set(types) | set(functions)


def check_public(*arguments):
    record = arguments[0] == "--record"
    headers, list_file, *libraries = arguments[record:]
    names = declared_in(headers)
    fields = [line.split(" ", 2) for library in libraries for line in nm(library, "-DC", "--defined-only")]
    symbols = sorted({symbol for _, kind, symbol in fields if kind == "T" and not INTERNAL.search(symbol)
                      and (m := re.match(r"twinray::(\w+)", symbol)) and m[1] in names})
    if record:
        pathlib.Path(list_file).write_text("\n".join(symbols) + "\n")
        return 0
    known = pathlib.Path(list_file).read_text().splitlines()
    changes = [f"new: {s}" for s in symbols if s not in set(known)]
    changes += [f"gone: {s}" for s in known if s not in set(symbols)]
    print("\n".join(changes) or f"check_symbols: all {len(symbols)} public ones are as listed")
    return changes or not symbols


CHECKS = {"ours": check_ours, "seen": check_seen, "public": check_public}
if len(sys.argv) < 3 or sys.argv[1] not in CHECKS:
    sys.exit(__doc__)
sys.exit(bool(CHECKS[sys.argv[1]](*sys.argv[2:])))
