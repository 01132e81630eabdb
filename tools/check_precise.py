#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks in SPIR-V that the compiler may not contract what watertightness rests on: in every function that comes from
HEADERS, each sum, difference, product and quotient of floats is NoContraction. In the modules that COUNTS names, each
function has as many of them as there, by any compiler: one that renamed or inlined them would leave nothing to check.
Usage: check_precise.py ROOT MODULE.spv...; prints each function with an operation that is not, and exits with 1; else
how many operations it has seen in which functions."""
import pathlib
import re
import sys

from spirv_module import instructions, text

HEADERS = ["include/twinray/glsl/exact.h", "include/twinray/glsl/transform.h", "shaders/shared/ray_space.h",
           "shaders/shared/intersect.h", "shaders/shared/refine.h", "shaders/shared/certified.h",
           "shaders/shared/exact_double.h", "shaders/collide/orient.h", "shaders/collide/world_vertex.h"]
# Not decided by bits that two triangles must share.
EXEMPT = {
    "intersect_triangle_fast": "level fast promises nothing at edges",
    "make_ray_space": "once for a ray: all triangles see the same constants",
    "reciprocal": "likewise",
    "vertex_pad": "twice of what it has to cover",
    "certified_ray": "what it gives is off by less than its bound, contracted or not",
    "may_begin_in_plane": "a filter, whose bound exceeds what contraction changes",
    "may_begin_in_plane_double": "likewise",
    "plane_side": "a filter; its sums and products are whole numbers",
    "whole_difference": "multiples of its unit, whose products with powers of two are exact",
    "certain_side": "a filter, whose bound exceeds what contraction changes",
    "is_finite_point": "a bound that nothing is near to",
    "intersect_in_world": "divisions that give u and v",
}
COUNTS = {
    "swtlas_trace": {"sheared": 5, "edge_function": 3, "accurate_edge_function": 1, "exact_side": 2, "crossing": 11},
}
NAME, FUNCTION, FUNCTION_END, DECORATE = 5, 54, 56, 71
ARITHMETIC = {129: "FAdd", 131: "FSub", 133: "FMul", 136: "FDiv", 142: "VectorTimesScalar", 148: "Dot"}
NO_CONTRACTION = 42
DEFINITION = re.compile(r"^FUNC \w+ (\w+)\(", re.M)


def operations(module):  # of each function by its name in GLSL: (NoContraction, all, which lack it)
    names, protected, counts, function = {}, set(), {}, None
    for opcode, operands in instructions(module):
        if opcode == NAME:
            names[operands[0]] = text(operands[1:])
        elif opcode == DECORATE and operands[1] == NO_CONTRACTION:
            protected.add(operands[0])
        elif opcode == FUNCTION:
            function = names.get(operands[1], "").split("(")[0]
        elif opcode in ARITHMETIC and function:
            entry = counts.setdefault(function, [0, 0, []])
            entry[1] += 1
            if operands[1] in protected:
                entry[0] += 1
            else:
                entry[2].append(ARITHMETIC[opcode])
    return counts


root, modules = pathlib.Path(sys.argv[1]), [pathlib.Path(name) for name in sys.argv[2:]]
wanted = {name for header in HEADERS for name in DEFINITION.findall((root / header).read_text())}
found = [f"check_precise: {name} is exempt, but no header has it" for name in EXEMPT if name not in wanted]
seen, total = set(), 0
for module in modules:
    counts = operations(module.read_bytes())
    for function in sorted(wanted & counts.keys() - EXEMPT.keys()):
        guarded, every, bare = counts[function]
        seen.add(function)
        total += guarded
        if bare:
            found.append(f"{module.name}: {function}: {len(bare)} of {every} operations may be contracted: {', '.join(bare)}")
    for function, wanted_count in COUNTS.get(module.stem, {}).items():
        count = counts.get(function, [0])[0]
        if count != wanted_count:
            found.append(f"{module.name}: {function}: {count} operations are NoContraction, not {wanted_count}")
if not seen:
    found.append("check_precise: no module has any of the functions")
print("\n".join(found) or f"check_precise: {total} operations of {len(modules)} modules are NoContraction, in {', '.join(sorted(seen))}")
sys.exit(1 if found else 0)
