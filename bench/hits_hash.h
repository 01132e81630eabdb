// SPDX-License-Identifier: MIT
// One number for all hits of a trace, to see at once whether two traces answered alike.
#pragma once

#include <cstdint>
#include <span>

#include "engine/accel/trace_desc.h"
#include "engine/core/ray.h"

namespace twinray::bench {

// FNV-1a of 64 bits (Fowler, Noll and Vo) over the hits in their order. Of closest hits hit, primitive_index,
// instance_index and the bits of t, u and v count; of any hits `hit` alone, as which one is found is free.
std::uint64_t hash_of(std::span<const Hit> hits, Query query);

}  // namespace twinray::bench
