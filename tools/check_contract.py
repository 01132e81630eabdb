#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks docs/contract.md against the tests: each test it names exists, each row names one, and each test of the contract
body is in a row. Usage: check_contract.py [ROOT]; prints the faults and exits with 1, else prints the numbers of rows and tests."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
page, body = root / "docs/contract.md", root / "tests/accel/accel_contract_test.cpp"
TEST = re.compile(r"^TEST(?:_[PF])?\((\w+),\s*(\w+)\)", re.M)


def tests_of(file):
    return [f"{suite}.{name}" for suite, name in TEST.findall(file.read_text(encoding="utf-8"))]


contract = tests_of(body)
existing = {test for file in (root / "tests").rglob("*.cpp") for test in tests_of(file)}
rows = [(number, line) for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1)
        if line.startswith("| ") and not line.startswith("| promise |")]
found, named = [], set()
for number, line in rows:
    tests = re.findall(r"`(\w+\.\w+)`", line.rstrip(" |").rsplit(" | ", 1)[-1])
    named.update(tests)
    if not tests:
        found.append(f"{page}:{number}: the row names no test")
    found += [f"{page}:{number}: no such test: {test}" for test in tests if test not in existing]
found += [f"{body}: {test} is in no row of {page.name}" for test in contract if test not in named]
if not rows or not contract:
    found.append(f"{page} has {len(rows)} rows, {body} {len(contract)} tests")
others = len(named - set(contract))
print("\n".join(found) or f"contract: {len(rows)} rows, held by {len(contract)} tests over four accelerators "
      f"({4 * len(contract)} runs) and {others} tests of other suites")
sys.exit(1 if found else 0)
