// SPDX-License-Identifier: MIT
// The memory of a traversal's stack: the workgroup's, a column for each invocation, or registers (STACK_CONSTANT). A
// kernel whose groups have more than 64 invocations defines TWINRAY_INVOCATIONS as their number before it includes
// twinray/glsl/query.glsl; TWINRAY_PRIVATE_STACK, in stages without workgroup memory, leaves the column out.
#ifndef TWINRAY_STACK_GLSL
#define TWINRAY_STACK_GLSL
#include "shaders/shared/features.h"

uint twinray_stack_registers[REGISTER_STACK_SIZE];

// Returns an entry in registers; `slot` is below REGISTER_STACK_SIZE. It is selected, because registers have no index.
uint entry_of_registers(uint slot) {
    uint entry = twinray_stack_registers[0];
    UNROLL for (uint i = 1u; i < REGISTER_STACK_SIZE; ++i) entry = slot == i ? twinray_stack_registers[i] : entry;
    return entry;
}
// Writes the entry.
void set_entry_of_registers(uint slot, uint entry) {
    UNROLL for (uint i = 0u; i < REGISTER_STACK_SIZE; ++i) twinray_stack_registers[i] =
        slot == i ? entry : twinray_stack_registers[i];
}

#ifdef TWINRAY_PRIVATE_STACK
uint stack_size() { return REGISTER_STACK_SIZE; }
uint load_entry(uint slot) { return entry_of_registers(slot); }
void store_entry(uint slot, uint entry) { set_entry_of_registers(slot, entry); }
#else
#ifndef TWINRAY_INVOCATIONS
// The workgroup's stacks.
#define TWINRAY_INVOCATIONS 64
#endif
layout(constant_id = STACK_CONSTANT) const uint STACK = STACK_SHARED;
shared uint twinray_stack[STACK_SIZE * TWINRAY_INVOCATIONS];

// Returns the number of entries that an invocation has.
uint stack_size() { return STACK == STACK_REGISTERS ? REGISTER_STACK_SIZE : STACK_SIZE; }
// Returns the entry at `slot`, which is below stack_size().
uint load_entry(uint slot) {
    if (STACK == STACK_REGISTERS) return entry_of_registers(slot);
    return twinray_stack[slot * TWINRAY_INVOCATIONS + gl_LocalInvocationIndex];
}
// Writes the entry at `slot`, which is below stack_size().
void store_entry(uint slot, uint entry) {
    if (STACK == STACK_REGISTERS)
        set_entry_of_registers(slot, entry);
    else
        twinray_stack[slot * TWINRAY_INVOCATIONS + gl_LocalInvocationIndex] = entry;
}
#endif
#endif
