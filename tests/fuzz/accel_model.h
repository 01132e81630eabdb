// SPDX-License-Identifier: MIT
// An accelerator after any history of calls, as docs/contract.md describes it, in a few plain arrays: which calls are
// refused, what is where, and what rays meet.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

namespace twinray::fuzz {

// The changes of the accelerator that the last sync has not seen.
enum class Pending : std::uint8_t { nothing, moves, structure };

// A mesh, or boxes, which no ray can meet without a program.
struct ModelGeometry {
    Mesh mesh;
    std::vector<Bounds> boxes;
    bool has_boxes = false;
    float unit = 1;  // of the positions at the last push or update
};

// The instances of one push. Handles may share a geometry.
struct ModelPlacing {
    AccelHandle handle;
    std::shared_ptr<ModelGeometry> geometry;
    std::vector<InstanceState> instances;
};

class AccelModel {
  public:
    std::vector<ModelPlacing> placings;  // of live handles, in push order
    std::vector<AccelHandle> dead;       // erased, of an earlier accelerator, or never given
    Pending pending = Pending::structure;
    std::uint64_t revision = 0;

    // Returns null for a dead handle.
    ModelPlacing* find(AccelHandle handle);
    void mark(Pending what) { pending = std::max(pending, what); }
    void sync();
    std::size_t instance_count() const;
    std::size_t geometry_count() const;
    // Returns whether a trace needs a program, for boxes or for instances that are not opaque.
    bool needs_program() const;
    // Tests each triangle of each instance.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, std::uint8_t mask, Cull cull) const;
    // Ends the process if the accelerator differs. Everything that it holds as bytes must be the same.
    void check(const AbstractAccel& accel) const;
};

// Returns whether push() takes them for a geometry in this unit: each transform, also times the unit, has an inverse,
// and each custom index has 24 bits.
bool is_placeable(float unit, std::span<const Transform> transforms, std::span<const InstanceOptions> options);

}  // namespace twinray::fuzz
