#!/usr/bin/env python3
"""Runs `twinray qualify` as continuous integration does.
Usage: qualify_command_test.py TWINRAY [FOLDER_OF_THE_BROKEN_DRIVER]"""
import json
import pathlib
import sys
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from command import here, records, run


def qualify(name, *arguments, status=0, **environment):
    out = here / name
    said = run("qualify", "--quiet", "--only", "W0*,S01,T01,K0*", "-o", str(out), "--junit", f"{out}.xml",
               "--tap", f"{out}.tap", "--sarif", f"{out}.sarif", *arguments, status=status, env=environment)
    suites = xml.etree.ElementTree.parse(f"{out}.xml").getroot().findall("testsuite")
    lines = pathlib.Path(f"{out}.tap").read_text().splitlines()
    log = json.loads(pathlib.Path(f"{out}.sarif").read_text())
    cases = [case for suite in suites for case in suite]
    assert lines[0] == "TAP version 14" and lines[1] == f"1..{len(cases)}"
    failures = sum(case.find("failure") is not None for case in cases)
    assert sum(int(suite.get("failures")) for suite in suites) == failures
    assert sum(result["level"] == "error" for result in log["runs"][0]["results"]) == failures
    assert f"of {len(cases)} checks failed" in said, said
    return suites, cases


suites, cases = qualify("one")
assert len(suites) == 1 and not [case.get("name") for case in cases if case.find("failure") is not None]
assert {"W01 sw watertight", "K01 hw"} & {case.get("name") for case in cases}
assert all(r["time"] is None for r in records("one/report.jsonl") if r["case"] in ("W01", "S01", "T01"))

if len(sys.argv) > 2:  # a driver whose distances are wrong
    broken = {"VK_ADD_LAYER_PATH": sys.argv[2], "VK_INSTANCE_LAYERS": "VK_LAYER_TWINRAY_broken_driver",
              "TWINRAY_BROKEN_DRIVER": "distance"}
    suites, cases = qualify("broken", "--strict", status=1, **broken)
    failed = {case.get("name") for case in cases if case.find("failure") is not None}
    assert "W01 hw watertight" in failed and "W01 sw watertight" not in failed, sorted(failed)[:20]

said = run("qualify", "--junit", str(here / "no/such/folder.xml"), status=1)
assert not (here / "twinray_qualify").exists(), said
print("qualify: the command works")
