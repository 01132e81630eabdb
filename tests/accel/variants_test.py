#!/usr/bin/env python3
"""Counts the instructions of trace.comp, its specialisation constants frozen and optimised by spirv-opt: each feature that
is left out must make it smaller, and the leanest variants may not outgrow instruction_counts.txt, which --record writes
anew. Usage: variants_test.py FEATURES_H COUNTS [--record] BACKEND=MODULE.spv..., BACKEND being sw or hw."""
import functools
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import frozen_spirv

QUERY, FEATURES, LEVEL = 0, 100, 101  # ids of the constants
CLOSEST, ANY, WATERTIGHT = 0, 1, 1
# The options that each backend may leave out; one of the layouts stays.
OPTIONAL = {"sw": ["BOXES", "FILTERS", "BVH2", "COMPRESSED8", "INSTANCES", "MASKS", "CULLING", "TRANSFORMS", "HITS"],
            "hw": ["BOXES", "FILTERS", "REMAP", "HITS"]}
LEAST = {"sw": ["COMPRESSED"], "hw": []}
# With one of these, an any hit of software needs its distance, so its kernel lacks the triangle test without a
# distance, which is longer though fewer of its instructions run. So each is added to a kernel that has another.
NEEDS_HIT = {"HITS": "FILTERS", "BOXES": "HITS", "FILTERS": "HITS"}

arguments = [a for a in sys.argv[1:] if a != "--record"]
header, counts_file = map(pathlib.Path, arguments[:2])
modules = dict(a.split("=", 1) for a in arguments[2:])
bits = {name: int(value) for name, value in re.findall(r"^const uint FEATURE_(\w+) = (\d+)u;", header.read_text(), re.M)}
uncovered = set(bits) - {name for names in [*OPTIONAL.values(), *LEAST.values()] for name in names}
assert not uncovered, f"no module leaves out {uncovered}: add them to the table"


@functools.cache
def count_of(module, query, features):
    return frozen_spirv.count(module, {QUERY: query, FEATURES: features, LEVEL: WATERTIGHT})


def count(module, query, features):
    return count_of(module, query, sum(bits[name] for name in features))


faults, counts = [], {}
recorded = {} if "--record" in sys.argv else dict(
    line.rsplit(" ", 1) for line in counts_file.read_text().splitlines() if line and line[0] != "#")
for backend, module in modules.items():
    everything = OPTIONAL[backend] + LEAST[backend]
    for query, query_name in ((CLOSEST, "closest"), (ANY, "any")):
        optional = [name for name in OPTIONAL[backend] if name != "HITS" or query == ANY]
        kept = [name for name in everything if name not in optional]
        least, most = count(module, query, kept), count(module, query, everything)
        print(f"{backend} {query_name}: {most} instructions with everything, {least} with {' '.join(kept) or 'nothing'}")
        for name in optional:
            without = count(module, query, [n for n in everything if n != name])
            base = kept + [NEEDS_HIT[name]] if backend == "sw" and query == ANY and name in NEEDS_HIT else kept
            added = count(module, query, base + [name]) - count(module, query, base)
            print(f"    {name:<11} {without - most:+6} left out of everything, {added:+6} added to the least")
            if without >= most or added < 0:
                faults.append(f"{backend} {query_name}: leaving {name} out leaves out nothing")
        key = f"{backend} {query_name} least"
        counts[key] = least
        if "--record" not in sys.argv and least > int(recorded.get(key, 0)):
            faults.append(f"{key}: {least} instructions, recorded are {recorded.get(key)}; --record if it must be so")

if "--record" in sys.argv:
    counts_file.write_text("# Written by variants_test.py --record: instructions of the leanest variants of trace.comp.\n" +
                           "".join(f"{key} {value}\n" for key, value in counts.items()))
print("\n".join(faults))
sys.exit(1 if faults else 0)
