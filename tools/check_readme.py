#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails unless the README's C++ example is samples/first_hit.cpp, which is compiled and run. --write updates it."""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
readme = root / "README.md"
code = (root / "samples/first_hit.cpp").read_text().split("\n", 1)[1].strip()
block = re.compile(r"(<!-- samples/first_hit.cpp -->\n```cpp\n).*?(```)", re.S)
text = readme.read_text()
wanted = block.sub(lambda match: match[1] + code + "\n" + match[2], text)
if "--write" in sys.argv:
    readme.write_text(wanted)
elif wanted != text or not block.search(text):
    sys.exit("README.md: the C++ example differs from samples/first_hit.cpp; run tools/check_readme.py --write")
