#!/usr/bin/env python3
"""Runs ctest and says how it went: each minute what is left; at the end what passed, failed and was skipped and why,
the ten slowest, and for each TEST that failed the command that runs it alone. Exit status: ctest's.
Usage: run_tests.py BUILD_FOLDER [what ctest takes]...

A test is a TEST of GoogleTest, whose suites are processes each, or a ctest of another kind.
"""

import collections
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

JOBS = 2


@dataclasses.dataclass
class Test:
    name: str
    seconds: float
    failed: bool = False
    reason: str = ""  # why it was skipped
    command: str = ""  # runs it alone


def tests_of_suite(file, build):
    """The TESTs that a process ran, by its XML, which it leaves at its end: none if it ended early."""
    for case in ElementTree.parse(file).getroot().iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        skipped = case.find("skipped")
        yield Test(
            name,
            float(case.get("time")),
            case.find("failure") is not None,
            "" if skipped is None else skipped.get("message").strip().splitlines()[-1],
            f"{build}/bin/{file.parent.name} --gtest_filter='{name}'",
        )


def tests_of(junit, results, build):
    suites = {file.stem: file for file in results.glob("*/*.xml")}
    for case in ElementTree.parse(junit).getroot().iter("testcase"):
        name = case.get("name")
        test = Test(name, float(case.get("time")), case.get("status") == "fail", command=f"ctest --test-dir {build} -R")
        test.command += f" '^{re.escape(name)}$'"
        if case.find("skipped") is not None:
            lines = (case.findtext("system-out") or "").strip().splitlines()
            test.reason = lines[-1] if lines else "no reason given"
        file = suites.get(name.replace("/", "."))
        of_suite = list(tests_of_suite(file, build)) if file else []
        if test.failed and not any(one.failed for one in of_suite):
            of_suite.append(test)  # the process ended early, or ran too long
        yield from of_suite or [test]


def tell(tests):
    failed = [test for test in tests if test.failed]
    reasons = collections.Counter(test.reason for test in tests if test.reason and not test.failed)
    print("\nThe slowest:")
    for test in sorted(tests, key=lambda test: -test.seconds)[:10]:
        print(f"{test.seconds:7.1f} s  {test.name}")
    for test in failed:
        print(f"failed: {test.name}\n    {test.command}")
    for reason, count in reasons.most_common():
        print(f"skipped, {count}: {reason}")
    passed = len(tests) - len(failed) - reasons.total()
    print(f"tests: {passed} passed, {len(failed)} failed, {reasons.total()} skipped")


class Progress:
    """A line a minute, by what each ctest took in the last run."""

    def __init__(self, build, selected):
        self.seconds = dict.fromkeys(selected, 0.0)
        costs = build / "Testing/Temporary/CTestCostData.txt"
        for line in costs.read_text(encoding="utf-8").splitlines() if costs.exists() else []:
            match = re.fullmatch(r"(.+) \d+ ([\d.e+-]+)", line)
            if match and match[1] in self.seconds:
                self.seconds[match[1]] = float(match[2])
        self.count, self.start, self.told = len(selected), time.monotonic(), 0
        self.was_run = any(self.seconds.values())

    def see(self, line):
        if match := re.match(r" *\d+/\d+ Test +#\d+: (.+?) \.\.", line):
            self.seconds.pop(match[1], None)
        minute = int((time.monotonic() - self.start) / 60)
        if minute > self.told:
            self.told = minute
            left = f", {sum(self.seconds.values()) / JOBS / 60:.1f} minutes to go" if self.was_run else ""
            print(f"-- minute {minute}: {self.count - len(self.seconds)} of {self.count}{left}", flush=True)


def main(build, *arguments):
    build = pathlib.Path(build).resolve()
    results, junit = build / "Testing/suites", build / "Testing/ctest.xml"
    shutil.rmtree(results, ignore_errors=True)
    junit.unlink(missing_ok=True)
    ctest = ["ctest", "--test-dir", build, *arguments]
    listed = subprocess.run([*ctest, "-N"], capture_output=True, text=True, check=True).stdout
    progress = Progress(build, re.findall(r"^ *Test +#\d+: (.+)$", listed, re.M))
    ctest += ["-j", str(JOBS), "--output-on-failure", "--no-tests=error", "--output-junit", junit]
    # Tests may leave temporary files: their folder is removed at the end.
    with (
        tempfile.TemporaryDirectory(prefix="twinray-tests-", ignore_cleanup_errors=True) as folder,
        subprocess.Popen(
            ctest, stdout=subprocess.PIPE, text=True, errors="replace", env={**os.environ, "TMPDIR": folder}
        ) as process,
    ):
        for line in process.stdout:
            print(line, end="", flush=True)
            progress.see(line)
    if junit.exists():
        tell(list(tests_of(junit, results, build)))
    return process.returncode


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
