#!/usr/bin/env python3
"""Runs `twinray verify --suite conformance` as a user does. Usage: conformance_command_test.py TWINRAY"""

import functools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import command
from command import here

verify = functools.partial(command.run, "verify", "--quiet")

said = verify("--suite", "conformance", "--json", here / "all.jsonl", "--validation")
records = command.records("all.jsonl")
cases = [record for record in records if not record["variant"]]
controls = [record for record in records if record["variant"].startswith("control: ")]
assert len(cases) > 90 and len(cases) + len(controls) == len(records)
assert all(record["schema"] == "twinray-report/1" and record["case"].startswith("K") for record in records)
assert all(record["pass"] for record in controls), [record["case"] for record in controls if not record["pass"]]
for topic in {record["results"]["topic"] for record in cases}:
    assert f"  {topic} " in said, f"no line of {topic}: {said}"
failed = [record for record in cases if record["pass"] is False]
for record in failed:
    assert f"    {record['case']} {record['backend']} {record['results']['demand']} " in said, said
    if record["example"]:
        assert record["example"] in said and len(record["example"].split()) == 9, record["example"]

# Under --strict, only Vulkan's demands count, not its advice. A driver that ends its process does not do so in the same
# cases each time.
demanded = any(record["results"]["demand"] == "must" for record in failed)
strict = verify("--suite", "conformance", "--strict", status=int(demanded))
assert strict.splitlines()[-1] == said.splitlines()[-1] or "the driver ended the process" in said + strict, strict

assert "--suite" in verify("--full", "scene.obj", status=2)
assert "--suite conformance" in verify(status=2)
assert "--suite conformance" in verify("scene.obj", "--suite", "conformance", status=2)
