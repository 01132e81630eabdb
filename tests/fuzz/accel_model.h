// SPDX-License-Identifier: MIT
// What docs/contract.md says an accelerator is after any history of calls, in a few plain arrays: which calls are
// refused, what is where, and what rays meet.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

namespace twinray::fuzz {

// How much of the accelerator the last sync has not seen.
enum class Pending : std::uint8_t { nothing, moves, structure };

// A mesh, or boxes: which no ray can meet without a program.
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
    std::vector<AccelHandle> dead;       // erased, of an accelerator before, or never given
    Pending pending = Pending::structure;
    std::uint64_t revision = 0;

    // Null for a dead handle.
    ModelPlacing* find(AccelHandle handle);
    void mark(Pending what) { pending = std::max(pending, what); }
    void sync();
    std::size_t instance_count() const;
    std::size_t geometry_count() const;
    // Whether a trace needs a program, for boxes or for instances that are not opaque.
    bool needs_program() const;
    // Tests each triangle of each instance.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, std::uint8_t mask, Cull cull) const;
    // Ends the process where the accelerator tells anything else. Of what it holds as bytes, each must be the same.
    void check(const AbstractAccel& accel) const;
};

// Whether push() takes them for a geometry in this unit: each transform has an inverse, times the unit, too, and each
// custom index has 24 bits.
bool is_placeable(float unit, std::span<const Transform> transforms, std::span<const InstanceOptions> options);

}  // namespace twinray::fuzz
