# SPDX-License-Identifier: MIT
"""Reads the words of SPIR-V modules."""
import struct


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
