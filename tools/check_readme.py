#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails unless the README's C++ lines are lines of samples/first_hit.cpp, one below the other: a test runs that."""
import pathlib
import re
import sys
import textwrap

root = pathlib.Path(__file__).resolve().parent.parent
code = (root / "samples/first_hit.cpp").read_text()
blocks = re.findall(r"<!-- samples/first_hit.cpp -->\n```cpp[^\n]*\n(.+?)```", (root / "README.md").read_text(), re.S)
if len(blocks) != 1 or textwrap.indent(blocks[0], "    ") not in code:
    sys.exit("README.md: the C++ lines below <!-- samples/first_hit.cpp --> are not lines of samples/first_hit.cpp")
