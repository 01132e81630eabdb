#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts what `ctest --output-junit FILE` wrote: a line of how many tests passed, failed and were skipped; then a line
for each reason of skipping, and the names of those that failed.
Usage: count_tests.py FILE"""

import collections
import re
import sys
import xml.etree.ElementTree as ElementTree

GTEST_REASON = re.compile(r": Skipped\n(.+)")


def reason_of(case):
    output = case.findtext("system-out") or ""
    if found := GTEST_REASON.search(output):
        return found[1].strip()
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    return lines[-1] if lines else "no reason given"


cases = ElementTree.parse(sys.argv[1]).getroot().findall("testcase")
failed = [case.get("name") for case in cases if case.get("status") == "fail"]
skipped = collections.Counter(reason_of(case) for case in cases if case.find("skipped") is not None)
print(len(cases) - len(failed) - skipped.total(), len(failed), skipped.total())
for reason, number in skipped.most_common():
    print(f"skipped, {number}: {reason}")
for name in failed:
    print(f"failed: {name}")
