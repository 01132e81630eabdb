// SPDX-License-Identifier: MIT
// Appends to a list and returns the index of the new element; from the list's capacity on there is no room for it.
uint append_to(ListTotal_ref total) {
    uint slot = atomicAdd(AT(total, 0).low, 1u);
    if (slot == 0xffffffffu) atomicAdd(AT(total, 0).high, 1u);
    return slot;
}
