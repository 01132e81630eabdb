#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The functions that the public headers declare and the shared libraries hold, against a committed list of them: what
programs link against changes on purpose alone.
Usage: public_symbols.py HEADERS LIST LIBRARY.so...            exit 1, with what came and what went, where they differ
       public_symbols.py --record HEADERS LIST LIBRARY.so...   writes the list anew"""
import pathlib
import re
import subprocess
import sys

INTERNAL = re.compile(r"::State::|Backend|\(anonymous namespace\)")


def declared(headers):
    """The names of types and functions in namespace twinray."""
    text = "".join(header.read_text() for header in sorted(pathlib.Path(headers).glob("*.h")))
    text = re.sub(r"//.*", "", text)
    types = re.findall(r"^(?:class|struct) (\w+)(?: final)?(?: :[^{;]*)? \{", text, re.M)
    functions = re.findall(r"^[\w:<>,&* ]+[ &*](\w+)\(", text, re.M)
    return set(types) | set(functions)


def exported(library):
    lines = subprocess.check_output(["nm", "-DC", "--defined-only", library], text=True).splitlines()
    return {line.split(" ", 2)[2] for line in lines if line.split(" ", 2)[1] == "T"}


def public(headers, libraries):
    names = declared(headers)
    symbols = set().union(*map(exported, libraries))
    return sorted(s for s in symbols if (m := re.match(r"twinray::(\w+)", s)) and m[1] in names and not INTERNAL.search(s))


def main(arguments):
    record = arguments[0] == "--record"
    headers, list_file, *libraries = arguments[record:]
    symbols = public(headers, libraries)
    if record:
        pathlib.Path(list_file).write_text("\n".join(symbols) + "\n")
        return 0
    known = pathlib.Path(list_file).read_text().splitlines()
    changes = [f"new: {s}" for s in symbols if s not in set(known)] + [f"gone: {s}" for s in known if s not in set(symbols)]
    print("\n".join(changes) or f"public_symbols: all {len(symbols)} as listed")
    return 1 if changes or not symbols else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
