// SPDX-License-Identifier: MIT
// The contract of both accelerators: geometry and instances by handles, a sync that builds, views that trace.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/accel/capability.h"
#include "engine/accel/features_of.h"
#include "engine/accel/geometry.h"
#include "engine/accel/instance_array.h"
#include "engine/accel/memory.h"
#include "engine/accel/own_programs.h"
#include "engine/accel/refinement.h"
#include "engine/accel/trace_desc.h"
#include "engine/accel/trace_program.h"
#include "engine/accel/vertices.h"
#include "engine/accel/world_bound.h"
#include "engine/core/commands.h"
#include "engine/core/ray.h"
#include "engine/core/transform.h"

namespace twinray {

class Pace;
class RaySort;

// Names what one push placed. Never reused; a handle of another accelerator or of something erased is dead.
struct AccelHandle {
    std::uint64_t id = 0;  // 0 = invalid

    bool operator==(const AccelHandle&) const = default;
};

// An instance as the accelerator holds it.
struct InstanceState {
    Transform transform;
    InstanceOptions options;
};

// The records of one handle's instances on the device, for kernels that move them. They may write object_to_world (12
// floats at offset 0 of each record) and must leave the rest. Valid as long as revision() does not change.
struct InstanceRange {
    VkBuffer buffer = VK_NULL_HANDLE;
    std::uint64_t offset = 0;     // of the first record, in bytes
    Ref<InstanceRecord> records;  // its device address
    std::size_t count = 0;
};

// What kernels need to trace: valid until the next sync() after which revision() has grown.
struct AccelView {
    std::uint64_t scene = 0;     // device address of the accelerator's scene block (SwTlasHeader or HwTlasHeader)
    std::uint64_t accel = 0;     // which accelerator made it
    std::uint64_t revision = 0;  // its revision() then
    uint features = 0;           // FEATURE_* of whatever traces of it may need: what kernels may be specialised for
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
    // The same for boxes, which only traces with a program can meet.
    AccelHandle push(const BoxesView& boxes, const Transform& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const BoxesView& boxes, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // False if the handle is dead already.
    bool erase(AccelHandle handle);
    // Another mesh, or other boxes, for all instances of the handle.
    void update(AccelHandle handle, const MeshView& mesh);
    void update(AccelHandle handle, const BoxesView& boxes);
    // New positions for the vertices of the handle's mesh, as many as it has; the triangles stay. The next sync refits
    // the geometry in place: views stay valid. A triangle with a corner that is not finite, or without an area, is
    // inactive until it is moved back.
    void update_vertices(AccelHandle handle, std::span<const vec3> positions);
    // The same from device memory, count times 3 tightly packed floats, read by the next sync. Nobody checks what lies
    // there.
    void update_vertices(AccelHandle handle, Floats positions, std::size_t count);

    // Transforms; custom indices, masks and flags stay. update_transform wants a handle with exactly one instance,
    // update_transforms one transform per instance. AccelOptions::can_move = false forbids all that moves instances.
    void update_transform(AccelHandle handle, const Transform& transform);
    void update_transforms(AccelHandle handle, std::span<const Transform> transforms);
    void update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform);
    // The same from device memory, read by the next sync. Nobody checks what lies there: an instance whose transform is
    // singular or not finite becomes inactive, and the accelerator warns how many.
    void update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count);
    // The caller's kernels write into instance_buffer(), then mark_transforms_dirty() lets the next sync take it over.
    InstanceRange instance_buffer(AccelHandle handle) const;
    void mark_transforms_dirty(AccelHandle handle);

    bool is_valid(AccelHandle handle) const { return placements_.contains(handle.id); }
    // Waits for the GPU if kernels may have moved the instances.
    InstanceState get_instance(AccelHandle handle, std::size_t index) const;
    std::vector<InstanceState> get_instances(AccelHandle handle) const;
    std::size_t n_instances() const;
    std::size_t n_instances(AccelHandle handle) const;  // 0 for a dead handle
    std::size_t n_geometries() const { return placements_.size(); }
    std::size_t n_primitives(AccelHandle handle) const;  // triangles or boxes of its geometry; 0 for a dead handle
    std::vector<AccelHandle> handles() const;            // those alive, in push order

    // Builds what changed since the last sync and returns the point at which the GPU has built it; a clean
    // accelerator does nothing. Where only transforms and vertices changed, everything is refitted in place and views
    // stay valid.
    // It never waits for the GPU: what in-flight work may still read is freed when the timeline has passed it.
    SyncPoint sync();
    // The same into the caller's command buffer, which must then be submitted: from here on the accelerator counts on
    // it. Whatever uses the result must run after it; closest_hits() wants it submitted before. If this throws, the
    // command buffer must not be submitted (and CallerCommands::done be reached without it).
    void sync(Commands& commands);
    // Whether geometries could go into less memory now (bottom levels of drivers can, once the GPU has built them,
    // until their vertices move). If so the next sync moves them, as every sync does that has other work, too; views
    // stay valid. A clean accelerator does not do so by itself: it would have to ask in each sync.
    bool compact();
    // Bytes of device memory that a sync may take for building geometries beyond what it keeps: they are built in
    // batches that fit, of one at least, and batches use the same memory one after the other. Results do not depend on
    // it. What the host uploads is staged on top. Default: 64 MiB.
    std::uint64_t scratch_budget() const { return scratch_budget_; }
    void set_scratch_budget(std::uint64_t bytes) { scratch_budget_ = bytes; }
    // Throws Error if edits are pending.
    AccelView view() const;
    // Counts the syncs that changed more than transforms and vertices: views of before are stale.
    std::uint64_t revision() const { return revision_; }

    // A box around all live instances at the last sync: the box of each geometry under its transform, rounded outward.
    // Empty for an empty accelerator. Waits for the last sync if it is not done.
    Bounds world_bound() const;
    // The same without waiting: nothing while the last sync is not done.
    std::optional<Bounds> world_bound_if_ready() const;
    // The same on the device, for kernels that run after the last sync.
    Ref<WorldBound> world_bound_on_device() const { return bound_.result(); }

    // How good the trees still are: the areas of the boxes of all children, leaves too, over the area of the root's
    // box, a measure of the time that rays take (the surface area heuristic); 0 where the root's box has no area.
    // Measured by the GPU in float32, with pairwise sums: right to 1e-5 of itself. What a driver builds is hidden: for
    // HwTlas it is an estimate, the cost of the tree that halves the driver's input again and again. The form without a
    // handle is about the top level, measured in each sync, the other about a geometry, measured from its first
    // update_vertices() on: nothing before. They wait for the last sync that measured.
    std::optional<double> sah() const { return sah_of(scene_costs_, Wait::yes); }
    std::optional<double> sah(AccelHandle handle) const;
    // The same without waiting: the latest that the GPU has done since the tree was last built; nothing while it has
    // none.
    std::optional<double> sah_if_ready() const { return sah_of(scene_costs_, Wait::no); }
    std::optional<double> sah_if_ready(AccelHandle handle) const;
    // A sync rebuilds what it would refit where sah_if_ready() has grown past this ratio to what it was at the last
    // build; addresses and views stay. At least 1; infinity: never. Throws Error otherwise.
    double rebuild_ratio() const { return rebuild_ratio_; }
    void set_rebuild_ratio(double ratio);

    // Records the trace; the hits are visible to later passes. Throws Error on a stale or foreign view.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    // The same in parts, if one submission might take too long (see Pace), into own commands. Throws Error where
    // TraceDesc::indirect_count is set, too.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const;
    // Host convenience: syncs, uploads, traces, waits and downloads. Of `desc` all counts but rays, hits, count, query
    // and answer_only.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    std::vector<Hit> any_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    // AccelView::features without what traces with this mask, cull and answer_only do not need: as long as revision()
    // does not change, kernels that ask for nothing else may be specialised for it. Throws Error if edits are pending.
    uint features_for(const TraceDesc& desc) const;
    // Until no program is left to compile in the background.
    void wait_for_programs() const;
    // A trace program for this accelerator, specialised for traces that need no more than `features`.
    std::unique_ptr<TraceProgram> make_program(const TraceProgramCode& code, uint features = FEATURES_ALL) const;

    // What this accelerator can do on its device.
    virtual Capability capability(Feature feature) const = 0;
    std::vector<Capability> capabilities() const;
    // Which of the two modules of a kernel with twinray/query.glsl fits.
    virtual bool is_software() const = 0;
    // Whether the driver's ids are mapped back to the user's.
    virtual bool reorders() const { return false; }

    void wait_for_gpu() { context_.wait_for_gpu(); }
    // GPU time per pass of the last sync() that built something into commands of its own; waits for it.
    std::vector<PassTiming> build_timings() const;
    // As of the last sync; what older work may still read is not counted.
    MemoryUsage memory_usage() const;
    // What the next sync will take for geometries and a top level that are not built yet: exactly what the structures
    // will be, but for meshes with nothing that could be hit, and all scratch. What the host uploads is staged on top.
    BuildBytes memory_requirements() const;
    // The same for an accelerator of nothing but such meshes and so many instances, before any is pushed.
    BuildBytes memory_requirements(std::span<const GeometrySize> geometries, std::size_t instance_count) const;

    const AccelOptions& options() const { return options_; }
    Context& context() const { return context_; }
    const std::string& name() const { return name_; }

  protected:
    // Throws Error naming the level that the device cannot do.
    AbstractAccel(Context& context, std::string name, const AccelOptions& options = {});

    // A geometry as the implementation built it.
    struct BuiltGeometry {
        virtual ~BuiltGeometry() = default;
        std::uint64_t bytes = 0;
    };
    // What to build a geometry from. `block` is what InstanceRecord::geometry points at, geometry_block_bytes long; the
    // implementation fills it, beginning with a GeometryBox. It stays when the geometry is replaced.
    struct GeometryInput {
        const Geometry* geometry;
        const Buffer* block;
        DeviceMesh mesh;               // where it is not null, this is built from, not the host's copy
        const BuiltGeometry* current;  // of an earlier sync and the same triangles, or null
        CostTarget cost;               // wants the cost measured that sah() tells, unless null
    };
    // Whether what was built by `done` could be smaller; nothing may wait.
    virtual bool can_compact(const BuiltGeometry&, SyncPoint) const { return false; }
    // Moves each `current`, of which can_compact() is true, into less memory.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> compact_geometries(Commands& commands,
                                                                           std::span<const GeometryInput> inputs);
    // The top level as the implementation built it.
    struct BuiltScene {
        virtual ~BuiltScene() = default;
        std::uint64_t address = 0;  // what AccelView::scene holds
        std::uint64_t bytes = 0;
        std::uint64_t scratch_bytes = 0;  // kept with it
        std::size_t capacity = 0;         // instances that it has room for
    };
    // What to build the top level from, all on the device by the time it runs.
    struct SceneInput {
        Ref<InstanceRecord> records;
        uint count = 0;
        Ref<WorldBound> bound;
        bool will_move = false;            // refits may follow
        CostTarget cost;                   // as in GeometryInput
        Ref<RefineScene> refinement = {};  // for its header; null below Level::refined
    };
    static constexpr std::uint64_t geometry_block_bytes = GEOMETRY_SOURCE_OFFSET + sizeof(GeometrySource);
    static constexpr double default_rebuild_ratio = 1.5;

    // One entry per input; null where the memory of `current` suffices.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> build_geometries(Commands& commands,
                                                                         std::span<const GeometryInput> inputs) = 0;
    // Adapts `current` to vertices that moved. One entry per input; null where its memory suffices.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> refit_geometries(Commands& commands,
                                                                         std::span<const GeometryInput> inputs) = 0;
    // Builds into the memory of `current` where that suffices, and then returns null.
    virtual std::unique_ptr<BuiltScene> build_scene(Commands& commands, const SceneInput& input,
                                                    const BuiltScene* current) = 0;
    // What building them from the host's memory takes.
    virtual BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const = 0;
    // What building a top level for `count` instances takes, with room for `capacity`.
    virtual BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const = 0;
    // Adapts `current`, built with will_move, to instances that only moved.
    virtual void refit_scene(Commands& commands, const SceneInput& input, const BuiltScene& current) = 0;
    // What an implementation built; throws Error on a dead handle or pending edits.
    const BuiltGeometry& built_geometry(AccelHandle handle) const;
    const Buffer& geometry_block(AccelHandle handle) const;
    // With the vertices that the device has, for which it waits; throws Error on a dead handle.
    Geometry geometry(AccelHandle handle) const;
    // Throws Error if edits are pending.
    void check_synced(const char* action) const;
    // Places what is built already; `block` is filled by commands submitted before the next sync. The records, which
    // need not name the block, may hold what push() would refuse: transforms that kernels have made unusable.
    AccelHandle push_built(Geometry&& geometry, Buffer&& block, std::unique_ptr<BuiltGeometry> built,
                           std::span<const InstanceRecord> records);
    const BuiltScene& built_scene() const;

    // What meshes with these positions are built in units of: a power of two.
    virtual float unit_of(std::span<const vec3> positions) const { return Geometry::near_unit(positions); }
    // With `code`, or with the accelerator's own code where the scene needs no program.
    virtual std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const = 0;
    std::uint64_t id() const { return id_; }
    // False: the host answers, and neither reads vertices in device memory nor measures costs.
    virtual bool works_on_device() const { return true; }
    // What closest_hits() and any_hits() do.
    virtual std::vector<Hit> trace_host(std::span<const Ray> rays, TraceDesc desc);

  private:
    // What one push placed.
    struct Placement {
        Geometry geometry;
        Buffer block;                          // see GeometryInput
        std::unique_ptr<BuiltGeometry> built;  // null: `geometry` is not built yet
        SyncPoint built_at;
        VertexSlice vertices;
        InstanceSlice instances;
        bool has_source = false;  // the block's GeometrySource is that of `geometry`

        void add_to(SceneFacts& facts) const;
    };
    struct Work;
    // What a sync recorded, to be committed once it is certain to run.
    struct Staged {
        VertexArrays::Staged vertices;
        std::vector<Placement*> sources;  // whose GeometrySource was written
        std::vector<bool> is_rebuilt;     // by moved item of `vertices`, which come first
        std::optional<Buffer> refinement;
        std::vector<Placement*> building;
        std::vector<std::unique_ptr<BuiltGeometry>> built;  // by `building`
        std::vector<InstanceSlice*> slices;
        InstanceArray::Staged instances;
        std::unique_ptr<BuiltScene> scene;
        bool is_scene_built = false;  // not refitted
        bool has_moved = false;

        void add(const Work& work, std::vector<std::unique_ptr<BuiltGeometry>>&& done);
    };
    enum class Dirty : std::uint8_t { no, compaction, moves, structure };  // moves: of instances and of vertices

    void mark(Dirty what) { dirty_ = std::max(dirty_, what); }
    AccelHandle place(Geometry&& geometry, std::span<const Transform> transforms,
                      std::span<const InstanceOptions> options);
    void replace(AccelHandle handle, Geometry&& geometry);
    InstanceRecord checked_record(const Placement& placement, std::size_t index, const Transform& transform,
                                  const InstanceOptions& options) const;
    Placement& live(AccelHandle handle, const char* action);
    const Placement& live(AccelHandle handle, const char* action) const;
    void warn_of_inactive_triangles(const Geometry& geometry) const;
    Placement& checked_for_vertices(AccelHandle handle, std::size_t count);
    void check_count(AccelHandle handle, const Placement& placement, std::size_t count) const;
    void check_index(AccelHandle handle, const Placement& placement, std::size_t index, const char* action) const;
    Staged stage(Commands& commands);
    void stage_vertices(Commands& commands, Staged& staged);
    void stage_sources(Commands& commands, Staged& staged);
    bool lacks_refinement(const Placement& placement) const;
    void stage_geometries(Commands& commands, Staged& staged);
    void stage_scene(Commands& commands, Staged& staged);
    void commit(Staged&& staged, SyncPoint done);
    enum class Wait : std::uint8_t { no, yes };
    std::optional<double> sah_of(const CostLog& costs, Wait wait) const;
    bool has_degraded(const CostLog& costs) const;
    bool is_compactable(const Placement& placement) const;
    AccelFacts accel_facts() const { return {is_software(), options_.layout, reorders()}; }
    SceneFacts facts_of_placements() const;
    void check_movable(const char* action) const;
    void warn_of_unusable_instances();
    const TraceProgram& own_program(uint features, const TraceDesc& desc) const;
    const TraceProgram& program_for(const TraceDesc& desc) const;
    void check_desc(const AccelView& view, const TraceDesc& desc) const;
    void check_buffers(const TraceDesc& desc) const;
    void record_rays(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    Uints record_order(Commands& commands, const TraceDesc& desc) const;

    Context& context_;
    std::string name_;
    std::uint64_t id_;
    AccelOptions options_;
    VertexArrays vertices_;
    InstanceArray instances_;
    std::unique_ptr<Refinement> refinement_;  // null below Level::refined
    WorldBoundKernel bound_;
    CostLog scene_costs_;
    double rebuild_ratio_ = default_rebuild_ratio;
    std::uint64_t scratch_budget_ = 64 << 20;
    std::map<std::uint64_t, Placement> placements_;  // in push order: ids only grow
    Dirty dirty_ = Dirty::structure;
    bool has_moved_ = false;  // something has moved after a build, so that builds allow refits
    std::uint64_t revision_ = 0;
    SceneFacts facts_;                                   // of the scene that was built
    mutable std::unique_ptr<OwnPrograms> own_programs_;  // made by the first trace
    mutable std::unique_ptr<RaySort> ray_sort_;          // made by the first that sorts
    SyncPoint synced_;
    uint warned_unusable_ = 0;
    std::unique_ptr<BuiltScene> scene_;
    // Its instances.
    std::size_t scene_count_ = 0;
    std::vector<std::unique_ptr<BuiltGeometry>> erased_;  // since the last sync: scene_ still refers to them
    std::unique_ptr<Commands> last_build_;
};

}  // namespace twinray
