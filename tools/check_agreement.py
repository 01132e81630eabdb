#!/usr/bin/env python3
"""Checks that two files agree; prints the faults and exits with 1, else prints what it compared.

Usage: check_agreement.py contract    docs/contract.md and the tests: each test it names exists, each row names one, and
                                      each test of the contract body is in a row
       check_agreement.py presets     presets that share a folder and cmake/options.cmake: one may find options on in
                                      the cache that another has set. Each that a preset leaves as it was, while it
                                      sets what the option needs to OFF, is a fault: CMake would refuse to configure.
       check_agreement.py readme      the README's C++ lines are lines of samples/first_hit.cpp, one below the other: a
                                      test runs that"""
import json
import pathlib
import re
import sys
import textwrap

root = pathlib.Path(__file__).resolve().parent.parent
TEST = re.compile(r"^TEST(?:_[PF])?\((\w+),\s*(\w+)\)", re.M)


def tests_of(file):
    return [f"{suite}.{name}" for suite, name in TEST.findall(file.read_text(encoding="utf-8"))]


def check_contract():
    page, body = root / "docs/contract.md", root / "tests/accel/accel_contract_test.cpp"
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
    return found, (f"contract: {len(rows)} rows, held by {len(contract)} tests over four accelerators "
                   f"({4 * len(contract)} runs) and {others} tests of other suites")


def check_presets():
    needs = re.findall(r"^twinray_option_needs\((\w+) ([\w ]+)\)", (root / "cmake/options.cmake").read_text(), re.M)
    listed = json.loads((root / "CMakePresets.json").read_text())["configurePresets"]
    presets = {preset["name"]: preset for preset in listed}

    def variables(name):
        preset = presets[name]
        inherited = variables(preset["inherits"]) if "inherits" in preset else {}
        return inherited | preset.get("cacheVariables", {})

    found = []
    for name in presets:
        off = {option for option, value in variables(name).items() if value == "OFF"}
        found += [f"preset {name}: {option} may be on from before, and needs {needed}" for option, all_needed in needs
                  for needed in all_needed.split() if needed in off and option not in off]
    return found, f"presets: {len(presets)} set all to OFF that needs what they set to OFF"


def check_readme():
    page, code = (root / "README.md").read_text(), (root / "samples/first_hit.cpp").read_text()
    blocks = re.findall(r"<!-- samples/first_hit.cpp -->\n```cpp[^\n]*\n(.+?)```", page, re.S)
    agrees = len(blocks) == 1 and textwrap.indent(blocks[0], "    ") in code
    fault = "README.md: the C++ lines below <!-- samples/first_hit.cpp --> are not lines of samples/first_hit.cpp"
    return [] if agrees else [fault], "readme: its C++ lines are those of samples/first_hit.cpp"


faults, told = {"contract": check_contract, "presets": check_presets, "readme": check_readme}[sys.argv[1]]()
print("\n".join(faults) or told)
sys.exit(1 if faults else 0)
