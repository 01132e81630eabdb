#!/usr/bin/env python3
"""llvmpipe with vectors of 128, 256 and 512 bits, and kernels of both rows of KernelTuning: the same hits to the last
bit.
Usage: vector_widths_test.py TWINRAY"""
import concurrent.futures
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command

devices = command.run("devices")
if "llvmpipe" not in devices:
    print("skipped: no device is llvmpipe, which LP_NATIVE_VECTOR_WIDTH is for")
    sys.exit(77)
if int(re.search(r"llvmpipe Mesa (\d+)", devices).group(1)) >= 26:
    print("skipped: lavapipe from Mesa 26.1 on crashes with vectors of another width than its own")
    sys.exit(77)


def hits_of(setting):
    """Hashes by what was traced."""
    width, tuning = setting
    file = f"{width}-{tuning}.jsonl"
    command.run("bench", "--quiet", "--json", file, "--pipelines", "", "--device", "llvmpipe", "--scene",
                "instances:12x80", "--width", "32", "--rounds", "1", "--levels", "fast,watertight,certified",
                "--backends", "sw", "--no-embree", "--no-build",
                env={"LP_NATIVE_VECTOR_WIDTH": str(width), "TWINRAY_TUNING": tuning})
    records = command.records(file)
    device = records[0]["device"]["name"]
    assert f"{width} bits" in device, f"{device} was to have vectors of {width} bits"
    return {(r["rays"], r["contestant"]): r["hits_hash"] for r in records}


settings = [(width, tuning) for width in (128, 256, 512) for tuning in ("gpu", "cpu_driver")]
with concurrent.futures.ThreadPoolExecutor(2) as workers:
    hits = dict(zip(settings, workers.map(hits_of, settings)))
first = hits[settings[0]]
assert len(first) >= 27 and all(first.values()) and len(set(first.values())) >= 4, first
for setting in settings[1:]:
    everything = first.keys() | hits[setting].keys()
    differing = sorted(what for what in everything if first.get(what) != hits[setting].get(what))
    assert not differing, f"{setting}: other hits than {settings[0]}: {differing}"
print(f"{len(first)} traces have the same hits with vectors of 128, 256 and 512 bits and kernels of both rows")
