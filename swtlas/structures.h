// The software accelerator's structures, build arguments and traversal for C++.
#pragma once

#include <array>

#include "engine/accel/surface_area.h"
#include "engine/accel/trace_desc.h"
#include "engine/core/radix_sort.h"

namespace twinray {
using glm::bitCount;
using glm::findMSB;
struct BvhChild;
using BvhChildren = Ref<BvhChild>;

// Returns the slots of a traversal's stack, of the thread that traces.
inline std::array<uint, STACK_SIZE>& stack_slots() {
    thread_local std::array<uint, STACK_SIZE> slots;
    return slots;
}
inline uint stack_size() { return STACK_SIZE; }
inline uint load_entry(uint slot) { return stack_slots()[slot]; }
inline void store_entry(uint slot, uint entry) { stack_slots()[slot] = entry; }

// Counts of a thread's traversals so far: nodes fetched, boxes tested, leaves fetched, and primitives of them tested in
// full. Kernels do not count.
struct TraversalSteps {
    std::uint64_t nodes = 0, boxes = 0, leaves = 0, primitives = 0;
};
inline TraversalSteps& traversal_steps() {
    thread_local TraversalSteps steps;
    return steps;
}

#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/collapse.h"
#include "shaders/shared/place_instance.h"
#include "shaders/shared/ploc.h"
#include "shaders/shared/rotate.h"
#include "shaders/shared/traverse.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(BvhNode) == 64 && sizeof(BvhChild) == 32 && sizeof(BvhTriangle) == 40 &&
              sizeof(SwInstance) == 104 && sizeof(CompressedRecord) == 40);
static_assert(sizeof(Bvh) == 40 && sizeof(SwGeometry) == 72 && sizeof(SwTlasHeader) == 80);
}  // namespace twinray
