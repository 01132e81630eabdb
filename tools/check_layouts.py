#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks in SPIR-V what Vulkan allows no type in Function storage: offsets of members or a stride of elements, which
are for memory (VUID-StandaloneSpirv-None-10684; spirv-val knows since 2025). glslang before 16 leaves them on copies of
a struct with an array member that a function which returns a buffer reference gives.
Usage: check_layouts.py MODULE.spv|LIST.txt..., a list having a module a line; prints each type of such variables, and
exits with 1; else how many variables it has seen."""
import pathlib
import sys

from spirv_module import instructions, text

NAME, TYPE_ARRAY, TYPE_RUNTIME_ARRAY, TYPE_STRUCT, TYPE_POINTER, VARIABLE = 5, 28, 29, 30, 32, 59
DECORATE, MEMBER_DECORATE, ARRAY_STRIDE, MATRIX_STRIDE, OFFSET = 71, 72, 6, 7, 35
FUNCTION_STORAGE = 7


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


modules = []
for name in sys.argv[1:]:
    modules += pathlib.Path(name).read_text().split() if name.endswith(".txt") else [name]
found, seen = set(), 0
for module in modules:
    for type_name, has_layout in types_of_locals(pathlib.Path(module).read_bytes()):
        seen += 1
        if has_layout:
            found.add(f"{pathlib.Path(module).name}: locals of type {type_name} have the layout of memory")
if not seen:
    found.add("check_layouts: no module has a variable in Function storage")
print("\n".join(sorted(found)) or f"check_layouts: {seen} variables of {len(modules)} modules have no layout")
sys.exit(1 if found else 0)
