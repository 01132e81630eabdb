#!/usr/bin/env python3
"""Measures programs for Windows under Wine against those for Linux, by turns: rays a second, and the time that a
program takes to its first hit. Run it on a machine that does nothing else.
Usage: speed.py LINUX_BIN WINDOWS_BIN"""
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

linux, windows = (pathlib.Path(folder).resolve() for folder in sys.argv[1:3])
held = tempfile.TemporaryDirectory(prefix="twinray-speed-")  # as long as this program
here = pathlib.Path(held.name)
ROUNDS, SIDES = 5, ("linux", "windows")


def environment(side):
    """With folders of compiled kernels for Mesa and, on Linux, for twinray. Wine's fonts need the usual caches."""
    cache = str(here / f"{side}-cache")
    return os.environ | {"MESA_SHADER_CACHE_DIR": cache} | ({"XDG_CACHE_HOME": cache} if side == "linux" else {})


def run(side, *arguments):
    command = [linux / "twinray"] if side == "linux" else ["wine", windows / "twinray.exe"]
    start = time.monotonic()
    subprocess.run([*command, *arguments], cwd=here, env=environment(side), check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - start


def processor_seconds():
    times = os.times()
    return times.children_user + times.children_system


def rates(side):
    record = here / "bench.jsonl"
    record.unlink(missing_ok=True)
    before = processor_seconds()
    run(side, "bench", "--scene", "instances:50x2000", "--backends", "sw,hw", "--levels", "watertight", "--layouts",
        "compressed4", "--rounds", "1", "--width", "256", "--max-seconds", "100", "--no-embree", "--no-build",
        "--quiet", "--json", record.name)
    records = map(json.loads, record.read_text().splitlines())
    busy = {"all of these, seconds of processors": processor_seconds() - before}
    return {f"{r['contestant']}, {r['rays']}": r["mrays_per_s"] for r in records}, busy


def forget(side):
    """No kernel is left that was compiled."""
    shutil.rmtree(here / f"{side}-cache", ignore_errors=True)
    if side == "windows":
        for cache in pathlib.Path(os.environ["WINEPREFIX"]).glob("drive_c/users/*/AppData/Local/twinray/cache"):
            shutil.rmtree(cache)


def compare(rows, is_rate):
    """rows: by side, dictionaries of values, one a round."""
    for name in rows["linux"][0]:
        ours, theirs = ([row[name] for row in rows[side]] for side in SIDES)
        ratio = statistics.median(b / a for a, b in zip(ours, theirs))
        unit = "Mrays/s" if is_rate else "s"
        print(f"{name:<44} Linux {statistics.median(ours):8.3f} {unit}, Wine {statistics.median(theirs):8.3f} {unit}, "
              f"Wine/Linux {ratio:.3f}", flush=True)
        ratios.setdefault(is_rate, []).append(ratio)


def first_hits():
    seconds = {side: [] for side in SIDES}
    for _ in range(ROUNDS):
        for side in SIDES:
            row = {"start alone": run(side, "--version")}
            for accel in ("sw", "hw"):
                forget(side)
                for state in ("cold", "warm"):
                    row[f"first hit, {accel}, {state}"] = run(side, "trace", "one.obj", "--rays", "one.csv", "--hits",
                                                              "hits.csv", "--accel", accel, "--quiet")
            seconds[side].append(row)
    return seconds


ratios = {}
(here / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
(here / "one.csv").write_text("0.2 0.2 1 0 0 -1\n")
for side in SIDES:
    rates(side)  # compiles kernels
measured = {side: [] for side in SIDES}
for _ in range(ROUNDS):
    for side in SIDES:
        measured[side].append(rates(side))
compare({side: [rate for rate, _ in rows] for side, rows in measured.items()}, True)
compare({side: [busy for _, busy in rows] for side, rows in measured.items()}, False)
compare(first_hits(), False)
print(f"rays a second: median of {len(ratios[True])} ratios {statistics.median(ratios[True]):.3f}, "
      f"least {min(ratios[True]):.3f}")
