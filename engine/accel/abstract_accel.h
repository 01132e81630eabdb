// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/accel/geometry.h"
#include "engine/core/commands.h"
#include "engine/core/ray.h"
#include "engine/core/transform.h"

namespace twinray {

// Names what one push placed. Never reused; a handle of another accelerator or of something erased is dead.
struct AccelHandle {
    std::uint64_t id = 0;  // 0 = invalid

    bool operator==(const AccelHandle&) const = default;
};

struct InstanceOptions {
    uint custom_index = 0;     // returned in Hit::custom_index; at most 2^24 - 1
    std::uint8_t mask = 0xff;  // an instance is seen by rays whose mask shares a bit
};

// What kernels need to trace: valid until the next sync() that changes something.
struct AccelView {
    std::uint64_t scene = 0;     // device address of the accelerator's scene block (SwScene or HwScene)
    std::uint64_t accel = 0;     // which accelerator made it
    std::uint64_t revision = 0;  // its revision() then
};

enum class Query : std::uint8_t { closest, any };

struct TraceDesc {
    Ref<Ray> rays;  // device address of count rays, 4-byte aligned
    Ref<Hit> hits;  // device address of count hits, written
    std::uint64_t count = 0;
    Query query = Query::closest;
    std::uint8_t mask = 0xff;
};

// The contract that both accelerators fulfil. Edits only note what changes; sync() is the only place that builds, and
// it never waits for the GPU. Wrong use throws Error naming the object, the value and the limit, and leaves the
// accelerator as it was.
class AbstractAccel {
  public:
    virtual ~AbstractAccel();
    AbstractAccel(const AbstractAccel&) = delete;
    AbstractAccel& operator=(const AbstractAccel&) = delete;

    // One geometry, one instance. The mesh is copied. An empty mesh is allowed and never hit.
    AccelHandle push(const MeshView& mesh, const Transform& transform = {}, const InstanceOptions& options = {});
    // One geometry, one instance per transform; options is empty or has one entry per transform.
    AccelHandle push(const MeshView& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // False if the handle is dead already.
    bool erase(AccelHandle handle);
    // The handle must have exactly one instance.
    void update_transform(AccelHandle handle, const Transform& transform);
    // One transform per instance of the handle; custom indices and masks stay.
    void update_transforms(AccelHandle handle, std::span<const Transform> transforms);
    void update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform);

    bool is_valid(AccelHandle handle) const { return placements_.contains(handle.id); }
    std::size_t n_instances() const;
    std::size_t n_instances(AccelHandle handle) const;  // 0 for a dead handle
    std::size_t n_geometries() const { return placements_.size(); }

    // Builds what changed since the last sync and returns the point at which the GPU has built it; a clean
    // accelerator does nothing. What in-flight work may still read is freed when the timeline has passed it.
    SyncPoint sync();
    // Throws Error if edits are pending.
    AccelView view() const;
    // Counts the syncs that changed something.
    std::uint64_t revision() const { return revision_; }
    // A box around all live instances at the last sync; empty for an empty accelerator.
    Bounds world_bound() const { return world_bound_; }

    // Records the trace; the hits are visible to later passes. Throws Error on a stale or foreign view.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    // Host convenience: syncs, uploads, traces, waits and downloads.
    std::vector<Hit> closest_hits(std::span<const Ray> rays);
    std::vector<Hit> any_hits(std::span<const Ray> rays);

    void wait_for_gpu() { context_.wait_for_gpu(); }
    // GPU time per pass of the last sync that built something; waits for it.
    std::vector<PassTiming> build_timings() const;
    // Bytes of device memory that the built structure holds.
    std::uint64_t structure_bytes() const;

    Context& context() const { return context_; }
    const std::string& name() const { return name_; }

  protected:
    AbstractAccel(Context& context, std::string name);

    // A geometry as the implementation built it.
    struct BuiltGeometry {
        virtual ~BuiltGeometry() = default;
        std::uint64_t reference = 0;  // what InstanceRecord::geometry holds
        std::uint64_t bytes = 0;
    };
    // The top level as the implementation built it.
    struct BuiltScene {
        virtual ~BuiltScene() = default;
        std::uint64_t address = 0;  // what AccelView::scene holds
        std::uint64_t bytes = 0;
    };
    // One instance of the new top level: its record and the geometry it places.
    struct PlacedInstance {
        InstanceRecord record;
        const Geometry* geometry;
        const BuiltGeometry* built;
    };

    virtual std::vector<std::unique_ptr<BuiltGeometry>> build_geometries(
        Commands& commands, std::span<const Geometry* const> geometries) = 0;
    virtual std::unique_ptr<BuiltScene> build_scene(Commands& commands, std::span<const PlacedInstance> instances) = 0;
    // What an implementation built; throws Error on a dead handle or pending edits.
    const BuiltGeometry& built_geometry(AccelHandle handle) const;
    const BuiltScene& built_scene() const;

    virtual void record_trace(Commands& commands, const TraceDesc& desc, std::uint64_t scene) const = 0;

  private:
    struct Placement {
        Geometry geometry;
        std::unique_ptr<BuiltGeometry> built;
        std::vector<InstanceRecord> instances;
    };
    InstanceRecord checked_record(std::string_view mesh, std::size_t index, const Transform& transform,
                                  const InstanceOptions& options) const;
    Placement& live(AccelHandle handle, const char* action);
    std::vector<PlacedInstance> placed_instances() const;
    std::vector<Hit> trace_host(std::span<const Ray> rays, Query query);

    Context& context_;
    std::string name_;
    std::uint64_t id_;
    std::map<std::uint64_t, Placement> placements_;  // in push order: ids only grow
    bool dirty_ = true;
    std::uint64_t revision_ = 0;
    SyncPoint synced_;
    Bounds world_bound_;
    std::unique_ptr<BuiltScene> scene_;
    std::vector<std::unique_ptr<BuiltGeometry>> erased_;  // since the last sync: scene_ still refers to them
    std::unique_ptr<Commands> last_build_;
};

}  // namespace twinray
