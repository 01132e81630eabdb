#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts the instructions of the path tracer's shade.comp, its specialisation constants frozen and optimised by spirv-opt:
each feature that a scene leaves out must make the kernel smaller, and the plainest may not outgrow what is known of it.
Usage: shade_variants_test.py SCENE_H MODULE.spv"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

header, module = pathlib.Path(sys.argv[1]), sys.argv[2]
ids = {name: int(value) for name, value in re.findall(r"^const uint PT_HAS_(\w+) = (\d+)u;", header.read_text(), re.M)}
# Light from somewhere there has to be, and where first surfaces go is no matter of the scene.
least, other = {"LOCAL_LIGHTS"}, {"AOVS", "QUEUES"}
most_of_the_plainest = 2800
folder = pathlib.Path(tempfile.mkdtemp())


def count(features):
    """Instructions between OpFunction and OpFunctionEnd, without labels and line numbers."""
    frozen = folder / "frozen.spv"
    values = " ".join(f"{number}:{str(name in features).lower()}" for name, number in ids.items())
    subprocess.run(["spirv-opt", "--scalar-block-layout", "--target-env=vulkan1.2", f"--set-spec-const-default-value={values}",
                    "--freeze-spec-const", "--fold-spec-const-op-composite", "-O", module, "-o", str(frozen)], check=True)
    data = frozen.read_bytes()
    words, at, inside, found = struct.unpack(f"<{len(data) // 4}I", data), 5, False, 0
    while at < len(words):
        opcode = words[at] & 0xFFFF
        inside = (inside or opcode == 54) and opcode != 56
        found += inside and opcode not in (8, 248, 317)
        at += words[at] >> 16
    return found


faults, everything = [], set(ids) - other
plainest, fullest = count(least), count(everything)
print(f"{fullest} instructions with everything, {plainest} for plain materials and local lights")
for name in sorted(everything - least):
    alone = count(least | {name})
    print(f"    {name:<12} {alone - plainest:+6} added to the plainest")
    if alone <= plainest:
        faults.append(f"{name} left out leaves out nothing")
if plainest > most_of_the_plainest:
    faults.append(f"the plainest kernel has {plainest} instructions, more than {most_of_the_plainest}")
print("\n".join(faults))
sys.exit(len(faults) > 0)
