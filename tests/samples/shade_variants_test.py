#!/usr/bin/env python3
"""Counts the instructions of the path tracer's shade.comp, its specialisation constants frozen and optimised by spirv-opt:
each feature that a scene leaves out must make the kernel smaller, and the plainest may not outgrow what is known of it.
Panes change shadow.comp alone; second texture coordinates occur only with textures.
Usage: shade_variants_test.py SCENE_H SHADE.spv SHADOW.spv"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import frozen_spirv

header, shade, shadow = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
ids = {name: int(value) for name, value in re.findall(r"^const uint PT_HAS_(\w+) = (\d+)u;", header.read_text(), re.M)}
# Some light must come from somewhere, and where first surfaces go does not depend on the scene.
least, other = {"LOCAL_LIGHTS"}, {"AOVS", "QUEUES"}
most_of_the_plainest = 3200


def count(features, module=shade):
    return frozen_spirv.count(module, {number: str(name in features).lower() for name, number in ids.items()})


def added(name):
    """Instructions that a feature adds to the plainest kernel in which it can occur."""
    module = shadow if name == "PANES" else shade
    base = least | {"TEXTURES"} if name == "SECOND_UVS" else least
    return count(base | {name}, module) - count(base, module)


faults, everything = [], set(ids) - other
plainest, fullest = count(least), count(everything)
print(f"{fullest} instructions with everything, {plainest} for plain materials and local lights")
for name in sorted(everything - least):
    more = added(name)
    print(f"    {name:<12} {more:+6} added")
    if more <= 0:
        faults.append(f"{name} left out leaves out nothing")
if plainest > most_of_the_plainest:
    faults.append(f"the plainest kernel has {plainest} instructions, more than {most_of_the_plainest}")
print("\n".join(faults))
sys.exit(len(faults) > 0)
