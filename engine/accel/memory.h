// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace twinray {

// Device memory that an accelerator holds, in bytes.
struct MemoryUsage {
    std::uint64_t geometries = 0;  // bottom levels, with the tables that lead back to the user's primitives
    std::uint64_t scene = 0;       // the top level
    std::uint64_t instances = 0;   // the records of all instances, and what refining needs of them
    std::uint64_t blocks = 0;      // what the records point at, one a geometry
    std::uint64_t vertices = 0;    // copies of the meshes whose vertices move, or that are refined
    std::uint64_t scratch = 0;     // kept from one sync to the next

    std::uint64_t structures() const { return geometries + scene; }
    std::uint64_t total() const { return structures() + instances + blocks + vertices + scratch; }
};

// What a build takes, in bytes.
struct BuildBytes {
    std::uint64_t structures = 0;  // stays
    std::uint64_t scratch = 0;     // until the GPU has built
};

// A geometry of which nothing but its size is known.
struct GeometrySize {
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
};

}  // namespace twinray
