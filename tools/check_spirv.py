#!/usr/bin/env python3
"""Checks in SPIR-V what no validator does; prints the faults and exits with 1, else prints what it has seen.

Usage: check_spirv.py precise ROOT MODULE.spv...
         The compiler may not contract what watertightness rests on: in every function that comes from HEADERS, each
         sum, difference, product and quotient of floats is NoContraction. In the modules that COUNTS names, each
         function has as many of them as there, by any compiler: one that renamed or inlined them would leave nothing
         to check.
       check_spirv.py layouts MODULE.spv|LIST.txt...    a list has a module a line
         No type in Function storage has offsets of members or a stride of elements, which Vulkan allows none, as they
         are for memory (VUID-StandaloneSpirv-None-10684; spirv-val knows since 2025). glslang before 16 leaves them on
         copies of a struct with an array member that a function which returns a buffer reference gives."""
import pathlib
import re
import struct
import sys

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
DEFINITION = re.compile(r"^FUNC \w+ (\w+)\(", re.M)
NAME, TYPE_ARRAY, TYPE_RUNTIME_ARRAY, TYPE_STRUCT, TYPE_POINTER = 5, 28, 29, 30, 32
FUNCTION, VARIABLE, DECORATE, MEMBER_DECORATE = 54, 59, 71, 72
ARITHMETIC = {129: "FAdd", 131: "FSub", 133: "FMul", 136: "FDiv", 142: "VectorTimesScalar", 148: "Dot"}
NO_CONTRACTION, ARRAY_STRIDE, MATRIX_STRIDE, OFFSET = 42, 6, 7, 35
FUNCTION_STORAGE = 7


def instructions(module):
    """Of a module's bytes: each instruction as (opcode, operands)."""
    words = struct.unpack(f"<{len(module) // 4}I", module)
    assert words[0] == 0x07230203, "not SPIR-V"
    at = 5
    while at < len(words):
        length, opcode = words[at] >> 16, words[at] & 0xFFFF
        yield opcode, words[at + 1:at + length]
        at += length


def text(words):
    """The string that operands begin with."""
    return struct.pack(f"<{len(words)}I", *words).split(b"\0")[0].decode()


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


def check_precise(root, *modules):
    wanted = {name for header in HEADERS for name in DEFINITION.findall((pathlib.Path(root) / header).read_text())}
    found = [f"check_spirv: {name} is exempt, but no header has it" for name in EXEMPT if name not in wanted]
    seen, total = set(), 0
    for module in map(pathlib.Path, modules):
        counts = operations(module.read_bytes())
        for function in sorted(wanted & counts.keys() - EXEMPT.keys()):
            guarded, every, bare = counts[function]
            seen.add(function)
            total += guarded
            if bare:
                lacking = f"{len(bare)} of {every} operations may be contracted: {', '.join(bare)}"
                found.append(f"{module.name}: {function}: {lacking}")
        for function, wanted_count in COUNTS.get(module.stem, {}).items():
            count = counts.get(function, [0])[0]
            if count != wanted_count:
                found.append(f"{module.name}: {function}: {count} operations are NoContraction, not {wanted_count}")
    if not seen:
        found.append("check_spirv: no module has any of the functions")
    return found, f"{total} operations of {len(modules)} modules are NoContraction, in {', '.join(sorted(seen))}"


def types_of_locals(module):  # each variable's type in Function storage: (its name in GLSL, whether it has a layout)
    names, laid_out, parts, pointees = {}, set(), {}, {}
    for opcode, operands in instructions(module):
        if opcode == NAME:
            names[operands[0]] = text(operands[1:])
        elif opcode == DECORATE and operands[1] == ARRAY_STRIDE:
            laid_out.add(operands[0])
        elif opcode == MEMBER_DECORATE and operands[2] in (OFFSET, MATRIX_STRIDE):
            laid_out.add(operands[0])
        elif opcode in (TYPE_ARRAY, TYPE_RUNTIME_ARRAY):
            parts[operands[0]] = operands[1:2]
        elif opcode == TYPE_STRUCT:
            parts[operands[0]] = operands[1:]
        elif opcode == TYPE_POINTER:
            pointees[operands[0]] = operands[2]
        elif opcode == VARIABLE and operands[2] == FUNCTION_STORAGE:
            inside = [pointees[operands[0]]]
            for part in inside:  # grows
                inside.extend(parts.get(part, ()))
            yield names.get(inside[0], "an array"), not laid_out.isdisjoint(inside)


def check_layouts(*names):
    modules = []
    for name in names:
        modules += pathlib.Path(name).read_text().split() if name.endswith(".txt") else [name]
    found, seen = set(), 0
    for module in modules:
        for type_name, has_layout in types_of_locals(pathlib.Path(module).read_bytes()):
            seen += 1
            if has_layout:
                found.add(f"{pathlib.Path(module).name}: locals of type {type_name} have the layout of memory")
    if not seen:
        found.add("check_spirv: no module has a variable in Function storage")
    return sorted(found), f"{seen} variables of {len(modules)} modules have no layout"


faults, told = {"precise": check_precise, "layouts": check_layouts}[sys.argv[1]](*sys.argv[2:])
print("\n".join(faults) or f"check_spirv: {told}")
sys.exit(1 if faults else 0)
