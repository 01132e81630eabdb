#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs `twinray qualify` as continuous integration does.
Usage: qualify_command_test.py TWINRAY [FOLDER_OF_THE_BROKEN_DRIVER]"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

twinray, here = sys.argv[1], pathlib.Path(tempfile.mkdtemp())


def qualify(name, *arguments, status=0, **environment):
    out = here / name
    run = subprocess.run(
        [twinray, "qualify", "--quiet", "--only", "W0*,S01,T01,K0*", "-o", str(out),
         "--junit", f"{out}.xml", "--tap", f"{out}.tap",
         "--sarif", f"{out}.sarif", *arguments], capture_output=True, text=True, env={**os.environ, **environment})
    assert run.returncode == status, f"{name}: status {run.returncode}\n{run.stdout}{run.stderr}"
    suites = xml.etree.ElementTree.parse(f"{out}.xml").getroot().findall("testsuite")
    lines = pathlib.Path(f"{out}.tap").read_text().splitlines()
    log = json.loads(pathlib.Path(f"{out}.sarif").read_text())
    cases = [case for suite in suites for case in suite]
    assert lines[0] == "TAP version 14" and lines[1] == f"1..{len(cases)}"
    failures = sum(case.find("failure") is not None for case in cases)
    assert sum(int(suite.get("failures")) for suite in suites) == failures
    assert sum(result["level"] == "error" for result in log["runs"][0]["results"]) == failures
    assert f"of {len(cases)} checks failed" in run.stdout, run.stdout
    return suites, cases


suites, cases = qualify("one")
assert len(suites) == 1 and not [case.get("name") for case in cases if case.find("failure") is not None]
assert {"W01 sw watertight", "K01 hw"} & {case.get("name") for case in cases}
assert all(r["time"] is None for r in map(json.loads, (here / "one/report.jsonl").read_text().splitlines())
           if r["case"] in ("W01", "S01", "T01"))

if len(sys.argv) > 2:  # a driver whose distances are wrong
    broken = {"VK_ADD_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_TWINRAY_broken_driver",
              "TWINRAY_BROKEN_DRIVER": "distance"}
    suites, cases = qualify("broken", "--strict", status=1, **broken)
    failed = {case.get("name") for case in cases if case.find("failure") is not None}
    assert "W01 hw watertight" in failed and "W01 sw watertight" not in failed, sorted(failed)[:20]

run = subprocess.run([twinray, "qualify", "--junit", str(here / "no/such/folder.xml")], capture_output=True, text=True)
assert run.returncode == 1 and not (here / "twinray_qualify").exists(), run.stderr
print("qualify: the command works")
