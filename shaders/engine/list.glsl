// SPDX-License-Identifier: MIT
// The index of a new element in a list; from the list's capacity on there is no room for it.
uint append_to(ListTotal_ref total)
{
    uint slot = atomicAdd(AT(total, 0).low, 1u);
    if (slot == 0xffffffffu) atomicAdd(AT(total, 0).high, 1u);
    return slot;
}
