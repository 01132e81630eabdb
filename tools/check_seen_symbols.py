#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each library asks for symbols of those alone that it is declared to see, or a host that links no more cannot link it.

Usage: check_seen_symbols.py FOLDER NAME=SEEN,... ...   with FOLDER/twinray_NAME.o of each
"""

import subprocess
import sys


def symbols(file, *options):
    text = subprocess.run(["nm", "--format=just-symbols", *options, file], check=True, capture_output=True, text=True)
    return set(text.stdout.split())


folder, declared = sys.argv[1], dict(argument.split("=") for argument in sys.argv[2:])
defined = {name: symbols(f"{folder}/twinray_{name}.o", "--defined-only", "--extern-only") for name in declared}


def seen_by(name):
    direct = [other for other in declared[name].split(",") if other]
    return {name, *direct}.union(*(seen_by(other) for other in direct))


wrong = 0
for name in declared:
    asked = symbols(f"{folder}/twinray_{name}.o", "--undefined-only")
    for other in set(declared) - seen_by(name):
        for symbol in sorted(asked & defined[other]):
            print(f"twinray::{name} asks for {symbol} of twinray::{other}, which it is not declared to see")
            wrong += 1
print(f"check_seen_symbols: {len(declared)} libraries, {wrong} symbols of others")
sys.exit(1 if wrong else 0)
