#!/usr/bin/env python3
"""Runs `twinray report` as a user does. Usage: report_command_test.py TWINRAY"""
import csv
import json
import pathlib
import shutil
import sys
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from command import here, records as lines, run


def report(*arguments, status=0, seconds="8"):
    """In so few seconds what is least certain is not asked again; a busy machine gets more for its first round."""
    said = run("report", "--quiet", "--validation", "--budget", seconds, *arguments, status=status)
    if "-o" in arguments and "--resume" not in arguments and status == 0 and seconds != "60":
        records = pathlib.Path(arguments[arguments.index("-o") + 1], "report.jsonl").read_text()
        if "was spent before its turn" in records:
            return report(*arguments, status=status, seconds="60")
    return said


first = here / "first"
report("--only", "N07,B10,N06", "-o", str(first), "--json", str(here / "all.jsonl"), seconds="10")
records = lines("first/report.jsonl")
assert records and lines("all.jsonl")[-len(records):] == records
assert {r["case"] for r in records} == {"N07", "B10", "N06"}
assert all(r["schema"] == "twinray-report/1" and r["device"]["driver"] and r["git"] for r in records)
judged = [r for r in records if r["case"] == "N07" and r["status"] == "run" and r["backend"] == "sw"]
assert judged and all(r["pass"] and r["n"] == 144 and r["faults"] == 0 for r in judged), judged
assert all(r["reason"] for r in records if r["status"] == "not run")

with open(first / "report.csv", newline="", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
assert [row["case"] for row in rows] == [r["case"] for r in records]
assert [row["n"] for row in rows] == [str(r["n"]) for r in records]

page = xml.etree.ElementTree.parse(first / "report.html").getroot()
text = "".join(page.itertext())
assert "float64 reference" in text and "N07" in text and "B10" in text
report("--only", "W04", "--accels", "sw", "-o", str(here / "plots"))
assert sorted(file.stem for file in (here / "plots/plots").glob("*.gp")) == ["leaks", "levels"]
if shutil.which("gnuplot"):
    page = xml.etree.ElementTree.parse(here / "plots/report.html").getroot()
    assert len(page.findall(".//{http://www.w3.org/2000/svg}svg[@aria-label]")) == 2

# The device's arithmetic: on a CPU driver every bit is that of the CPU reference.
report("--only", "F06,F07,F08,F09", "--accels", "sw", "-o", str(here / "floats"))
floats = [r for r in lines("floats/report.jsonl") if r["status"] == "run"]
assert {r["case"] for r in floats} == {"F06", "F07", "F08", "F09"}
if "llvmpipe" in floats[0]["device"]["name"]:
    arithmetic = [r for r in floats if r["case"] == "F09"]
    assert arithmetic and all(r["pass"] and r["faults"] == 0 and r["n"] > 0 for r in arithmetic), arithmetic

# Compares with a baseline in which a count was better and a case passed.
better = [dict(r, faults=0, counts={}) for r in records]
(here / "old.jsonl").write_text("".join(json.dumps(r) + "\n" for r in better))
report("--only", "N07", "--accels", "sw", "--levels", "watertight", "-o", str(here / "second"), "--baseline",
       str(here / "old.jsonl"))
again = lines("second/report.jsonl")
assert {(r["backend"], r["level"]) for r in again} == {("sw", "watertight")}
assert [r["counts"] for r in again] == [r["counts"] for r in records
                                        if (r["case"], r["backend"], r["level"]) == ("N07", "sw", "watertight")]

# Compares with a baseline to which other commands have appended, and with a broken one.
with open(here / "old.jsonl", "a", encoding="utf-8") as old:
    old.write('{"schema": "twinray-trace/1", "n": 3}\n{"schema": "twinray-report/1", "case": "verify.random", "n": 5}\n')
again = ["--only", "N07", "--accels", "sw", "--levels", "watertight", "--baseline", str(here / "old.jsonl")]
said = report(*again, "-o", str(here / "mixed"))
n = len(lines("mixed/report.jsonl"))
assert f"{n} measurements compared" in said and "not compared: 1 of twinray-trace/1, 1 of verify.random" in said, said
with open(here / "old.jsonl", "a", encoding="utf-8") as old:
    old.write('{"schema": ')
assert f"{n} measurements compared" in report(*again, "-o", str(here / "mixed")), "its last line was cut short"
with open(here / "old.jsonl", "a", encoding="utf-8") as old:
    old.write('\n')
number = len((here / "old.jsonl").read_text().splitlines())
said = run("report", *again, "-o", str(here / "third"), status=1)
assert f"{here / 'old.jsonl'}' line {number}: not a JSON object" in said, said
report("--only", "N07", "-o", str(here / "third"), "--baseline", str(here / "none.jsonl"), status=1)
assert not (here / "third").exists(), "a report was begun although its baseline cannot be read"
# Compares reports: nothing has changed, and a result that was made worse is found.
said = report("--compare", str(first), str(first / "report.jsonl"), "--json", str(here / "compared.json"))
assert "verdict: no change beyond noise" in said and lines("compared.json")[0]["changes"] == [], said
def made_worse(r):
    is_ours_to_spoil = r["case"] == "N07" and r["status"] == "run"
    return dict(r, counts={"HW_LEAK": r["n"]}, faults=r["n"], **{"pass": False}) if is_ours_to_spoil else r


worse = [made_worse(r) for r in lines("first/report.jsonl")]
(here / "worse.jsonl").write_text("".join(json.dumps(r) + "\n" for r in worse))
said = report("--compare", str(first), str(here / "worse.jsonl"), str(first), status=1)
assert "worse: N07" in said and "verdict: worse" in said and "verdict: no change beyond noise" in said, said
report("--compare", str(first), status=2)
report("--compare", str(first), str(here / "none"), status=1)

# Negative controls show faults in both layouts, or the report fails.
for layout in ("compressed4", "bvh2"):
    report("--only", "W14,W15", "--accels", "sw", "--layout", layout, "-o", str(here / ("controls_" + layout)))
    assert sum(r["variant"].startswith("control: ") and bool(r["pass"])
               for r in lines("controls_" + layout + "/report.jsonl")) >= 2
# An interrupted run resumes with the case whose records it was writing.
progress = json.loads((first / "progress.json").read_text())
cut = records[-1]["case"]
del progress["cases"][cut]
(first / "progress.json").write_text(json.dumps(progress))
whole = (first / "report.jsonl").read_text()
(first / "report.jsonl").write_text(whole[:-20])
report("--only", "N07,B10,N06", "-o", str(first), "--resume", seconds="10")
began = records[0]["run"]
gone_on = sorted((r["case"], r["backend"], r["level"], r["run"] == began) for r in lines("first/report.jsonl"))
assert gone_on == sorted((r["case"], r["backend"], r["level"], r["case"] != cut) for r in records)
report("--only", "N07", "-o", str(first), "--resume", status=1)
report("--only", "N07", "-o", str(here / "nothing"), "--resume", status=1)
report("--accels", "gpu", status=2)
report("--only", "Q99", "-o", str(here / "fourth"), status=2)
print("report: the command works")
