// Implements AbstractAccel: the common part of both accelerators, and the steps that each does in its own way.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <twinray/abstract_accel.h>

#include "engine/accel/geometry.h"
#include "engine/accel/instance_array.h"
#include "engine/accel/surface_area.h"

namespace twinray {

struct AccelTraits;
class BoundOfSync;
class MeshStore;
struct MeshOnDevice;
class PipelineVariants;
class RaySort;
class Refinement;
struct SceneTraits;
struct SurfaceKernels;
struct SurfaceSlice;
class SurfaceTables;
class WorldBoundKernel;

// Its public functions are those of AbstractAccel, where they are documented.
class AccelBackend {
  public:
    virtual ~AccelBackend();
    AccelBackend(const AccelBackend&) = delete;
    AccelBackend& operator=(const AccelBackend&) = delete;
    AccelHandle push(const MeshView& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    AccelHandle push(const BoxesView& boxes, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    AccelHandle push(const DeviceMesh& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    AccelHandle push_instances_of(AccelHandle handle, std::span<const Transform> transforms,
                                  std::span<const InstanceOptions> options = {});
    bool erase(AccelHandle handle);
    void update(AccelHandle handle, const DeviceMesh& mesh);
    void mark_vertices_dirty(AccelHandle handle);
    void update(AccelHandle handle, const MeshView& mesh);
    void update(AccelHandle handle, const BoxesView& boxes);
    void update_vertices(AccelHandle handle, std::span<const vec3> positions);
    void update_vertices(AccelHandle handle, Floats positions, std::size_t count);
    void update_transform(AccelHandle handle, const Transform& transform);
    void update_transforms(AccelHandle handle, std::span<const Transform> transforms);
    void update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform);
    void update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count);
    void update_options(AccelHandle handle, std::size_t index, const InstanceOptions& options);
    std::size_t append_instances(AccelHandle handle, std::span<const Transform> transforms,
                                 std::span<const InstanceOptions> options = {});
    void erase_instance(AccelHandle handle, std::size_t index);
    InstanceRange instance_buffer(AccelHandle handle) const;
    void mark_transforms_dirty(AccelHandle handle);
    bool is_valid(AccelHandle handle) const { return pushed_.contains(handle.id); }
    InstanceState get_instance(AccelHandle handle, std::size_t index) const;
    std::vector<InstanceState> get_instances(AccelHandle handle) const;
    std::size_t n_instances() const { return instance_count_; }
    std::size_t n_instances(AccelHandle handle) const;  // 0 for a dead handle
    std::size_t n_geometries() const { return held_geometries().size(); }
    std::size_t n_primitives(AccelHandle handle) const;  // triangles or boxes of its geometry; 0 for a dead handle
    std::vector<AccelHandle> handles() const;            // those alive, in push order
    SyncPoint sync();
    void sync(Commands& commands);
    bool compact();
    std::uint64_t scratch_budget() const { return scratch_budget_; }
    void set_scratch_budget(std::uint64_t bytes) { scratch_budget_ = bytes; }
    AccelView view() const;
    std::uint64_t revision() const { return revision_; }
    Bounds object_bound(AccelHandle handle) const;
    Bounds world_bound() const;
    std::optional<Bounds> world_bound_if_ready() const;
    Ref<WorldBound> world_bound_on_device() const;
    std::optional<double> sah() const;
    std::optional<double> sah(AccelHandle handle) const;
    std::optional<double> sah_if_ready() const { return sah_of(scene_costs_, Wait::no); }
    std::optional<double> sah_if_ready(AccelHandle handle) const;
    double rebuild_ratio() const { return rebuild_ratio_; }
    void set_rebuild_ratio(double ratio);
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const;
    std::vector<Hit> closest_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    std::vector<Hit> any_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    std::vector<HitExact> exact_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});
    std::vector<Surface> surfaces(std::span<const Ray> rays, std::span<const Hit> hits) const;
    std::vector<vec4> attributes(std::string_view name, std::span<const Ray> rays, std::span<const Hit> hits,
                                 vec4 missing) const;
    uint attribute_number(std::string_view name) const;
    AccelHandle handle_of(const Hit& hit) const;
    std::size_t index_in_handle(const Hit& hit) const;
    uint features_for(const TraceDesc& desc) const;
    void wait_for_programs() const;
    std::unique_ptr<TraceProgram> make_program(const TraceProgramCode& code, uint features = ~0u) const;

    virtual Capability capability(Feature feature) const = 0;
    std::vector<Capability> capabilities() const;
    virtual bool is_software() const = 0;
    // Returns whether the driver's ids are mapped back to the user's.
    virtual bool reorders() const { return false; }
    void wait_for_gpu() { context_.wait_for_gpu(); }
    std::vector<PassTiming> build_timings() const;
    MemoryUsage memory_usage() const;
    BuildBytes memory_requirements() const;
    BuildBytes memory_requirements(std::span<const GeometrySize> geometries, std::size_t instance_count) const;
    SharedMesh mesh(AccelHandle handle) const;
    // Returns the mesh as the last sync left it; records the commands that bring it to the device if it is not there.
    MeshOnDevice lend_mesh(Commands& commands, AccelHandle handle);
    std::vector<uint> face_metadata(AccelHandle handle) const;  // of each triangle; 0 if none was kept; waits
    // Counts the syncs that moved or changed something.
    std::uint64_t edit_count() const { return edit_count_; }
    const AccelOptions& options() const { return options_; }
    Context& context() const { return context_; }
    const std::string& name() const { return name_; }

    // A geometry as the implementation built it.
    struct BuiltGeometry {
        virtual ~BuiltGeometry() = default;
        std::uint64_t bytes = 0;
    };
    // The top level as the implementation built it.
    struct BuiltTlas {
        virtual ~BuiltTlas() = default;
        std::uint64_t address = 0;  // AccelView::scene
        std::uint64_t bytes = 0;
        std::uint64_t scratch_bytes = 0;  // kept with it
        std::size_t capacity = 0;         // instances that it has room for
    };
    // The one instance of a scene, if no kernel may have written its record and it can be hit.
    struct SoleInstance {
        InstanceRecord record;  // in built units
        const BuiltGeometry& geometry;
    };
    // The input for building the top level, all on the device by the time it runs.
    struct TlasInput {
        Ref<InstanceRecord> records;
        uint count = 0;
        BoundOfSync* bound = nullptr;  // never null
        bool will_move = false;        // refits may follow
        CostTarget cost = {};          // as in GeometryInput
        AccelHeader header = {};       // the start of the top level
        std::optional<SoleInstance> sole = {};
    };

  protected:
    // Throws Error naming the level that the device does not support.
    AccelBackend(Context& context, std::string name, const AccelOptions& options = {});

    // The input for building a geometry. `block` is the target of InstanceRecord::geometry, geometry_block_bytes long;
    // the implementation fills it, beginning with a GeometryBox. It stays when the geometry is replaced.
    struct GeometryInput {
        const Geometry* geometry;
        const Buffer* block;
        PackedMesh mesh;               // the source of the build instead of the host's copy, unless null
        PackedMesh kept;               // the device's copy as long as it has the geometry, or null
        const BuiltGeometry* current;  // from an earlier sync and the same triangles, or null
        CostTarget cost;               // measures the cost for sah(), unless null
    };
    // Returns whether a build asked the GPU how small it can be.
    virtual bool has_compaction(const BuiltGeometry&) const { return false; }
    // Tells whether geometries built by `done` can be smaller, or the GPU's answer is not there yet; it must not wait.
    enum class Compaction : std::uint8_t { none, untold, possible };
    virtual Compaction compaction_of(const BuiltGeometry&, SyncPoint) const { return Compaction::none; }
    // Moves each `current` that can be smaller into less memory.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> compact_geometries(Commands& commands,
                                                                           std::span<const GeometryInput> inputs);
    static constexpr std::uint64_t geometry_block_bytes = GEOMETRY_SOURCE_OFFSET + sizeof(GeometrySource);
    static constexpr double default_rebuild_ratio = 1.5;

    // Returns one entry per input; null where the memory of `current` suffices.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> build_geometries(Commands& commands,
                                                                         std::span<const GeometryInput> inputs) = 0;
    // Adapts `current` to vertices that moved. One entry per input; null where its memory suffices.
    virtual std::vector<std::unique_ptr<BuiltGeometry>> refit_geometries(Commands& commands,
                                                                         std::span<const GeometryInput> inputs) = 0;
    // Builds into the memory of `current` if that suffices, and then returns null.
    virtual std::unique_ptr<BuiltTlas> build_tlas(Commands& commands, const TlasInput& input,
                                                  const BuiltTlas* current) = 0;
    // Returns the memory for building them from the host's memory.
    virtual BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const = 0;
    virtual BuildBytes bytes_of(std::span<const Geometry* const> geometries) const;
    // Returns the memory for building a top level for `count` instances, with room for `capacity`.
    virtual BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const = 0;
    // Measures `current` as it was built last.
    virtual void measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const = 0;
    // Adapts `current`, built with will_move, to instances that differ only in their transforms.
    virtual void refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) = 0;
    // Returns the implementation's geometry; throws Error on a dead handle or pending edits.
    const BuiltGeometry& built_geometry(AccelHandle handle) const;
    const Buffer& geometry_block(AccelHandle handle) const;
    // Returns it with the vertices on the device, for which it waits; throws Error on a dead handle.
    Geometry geometry(AccelHandle handle) const;
    // Throws Error if edits are pending.
    void check_synced(const char* action) const;
    // Places a built geometry; `block` is filled by commands submitted before the next sync. The records need not name
    // the block and may hold what push() would refuse: transforms that kernels have made unusable.
    AccelHandle push_built(Geometry&& geometry, Buffer&& block, std::unique_ptr<BuiltGeometry> built,
                           std::span<const InstanceRecord> records);
    const BuiltTlas& built_tlas() const;

    // Returns the unit in which meshes with these positions are built: a power of two.
    virtual float unit_of(std::span<const vec3> positions) const;
    // Chooses Geometry::leaves and welded of a mesh in host memory.
    virtual void prepare(Geometry&) const {}
    // Uses `code`, or the accelerator's own code if the scene needs no program.
    virtual std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const = 0;
    std::uint64_t id() const { return id_; }
    // Returns whether the GPU has finished the last sync.
    bool is_sync_done() const { return context_.is_reached(synced_); }
    // Returns false if the host traces, and neither reads vertices in device memory nor measures costs.
    virtual bool works_on_device() const { return true; }
    // Returns whether they are on the device even if their vertices do not move.
    bool keeps_meshes_on_device() const { return refinement_ || options_.keeps_surfaces; }
    // Traces for closest_hits() and any_hits().
    virtual std::vector<Hit> trace_host(std::span<const Ray> rays, TraceDesc desc);

  private:
    struct HeldGeometry;
    // The geometry and the instances of one push.
    struct PushedGeometry {
        std::shared_ptr<HeldGeometry> held;
        InstanceSlice instances = {};

        bool is_synced() const;

        void add_to(SceneTraits& traits) const;
    };
    struct Work;
    struct Staged;
    // The handles of the instances that the last sync placed, made by the first query after it.
    struct InstanceOwners {
        struct Owner {
            AccelHandle handle;
            std::size_t first_instance, primitive_count;
        };
        std::uint64_t revision = 0;
        std::vector<uint> of_instance;  // index into `all`
        std::vector<Owner> all;
    };
    enum class Dirty : std::uint8_t { no, compaction, moves, structure };  // moves: of instances and of vertices

    void mark(Dirty what) { dirty_ = std::max(dirty_, what); }
    // Makes the next sync examine the geometry and the handle's instances.
    void edit(const std::shared_ptr<HeldGeometry>& held, Dirty what);
    void edit(AccelHandle handle, Dirty what);
    AccelHandle place(std::shared_ptr<HeldGeometry> held, std::span<const Transform> transforms,
                      std::span<const InstanceOptions> options);
    AccelHandle place(Geometry&& geometry, SurfaceSlice&& surface, std::span<const Transform> transforms,
                      std::span<const InstanceOptions> options);
    AccelHandle add(PushedGeometry&& pushed);
    void check_mesh_is_kept(const HeldGeometry& held, const char* action) const;
    void replace(AccelHandle handle, Geometry&& geometry, SurfaceSlice&& surface);
    template <class Mesh>
    SurfaceSlice surface_of(const Mesh& mesh);
    Geometry geometry_of(const MeshView& mesh) const;
    Geometry geometry_of(const DeviceMesh& mesh, const char* action) const;
    void check_option_count(const std::string& mesh, std::size_t transforms, std::size_t options) const;
    std::vector<InstanceRecord> newest_records(const InstanceSlice& slice) const;
    InstanceRecord checked_record(const PushedGeometry& pushed, std::size_t index, const Transform& transform,
                                  const InstanceOptions& options) const;
    PushedGeometry& live(AccelHandle handle, const char* action);
    const PushedGeometry& live(AccelHandle handle, const char* action) const;
    void warn_of_inactive_triangles(const Geometry& geometry) const;
    const InstanceOwners& instance_owners(const char* action) const;
    const InstanceOwners::Owner& owner_of(const Hit& hit, const char* action) const;
    void check_keeps_surfaces(const char* action) const;
    void check_hits(std::span<const Ray> rays, std::span<const Hit> hits, const char* action) const;
    template <class Out, class Record>
    std::vector<Out> of_hits(std::span<const Ray> rays, std::span<const Hit> hits, const Record& record) const;
    PushedGeometry& checked_for_vertices(AccelHandle handle, std::size_t count);
    void check_count(AccelHandle handle, const PushedGeometry& pushed, std::size_t count) const;
    void check_index(AccelHandle handle, const PushedGeometry& pushed, std::size_t index, const char* action) const;
    Staged stage(Commands& commands, bool wants_bound);
    void list_geometries(Staged& staged) const;
    std::vector<InstanceSlice*> slices_to_stage();
    void stage_meshes(Commands& commands, Staged& staged);
    void stage_surfaces(Commands& commands, Staged& staged);
    void stage_sources(Commands& commands, Staged& staged);
    static PackedMesh kept_mesh(const HeldGeometry& held, const Staged& staged);
    bool lacks_mesh(const HeldGeometry& held) const;
    void stage_geometries(Commands& commands, Staged& staged);
    void stage_scene(Commands& commands, Staged& staged, BoundOfSync& bound);
    std::optional<SoleInstance> sole_instance(const Staged& staged) const;
    void measure_bound() const;
    void commit(Staged&& staged, SyncPoint done);
    enum class Wait : std::uint8_t { no, yes };
    std::optional<double> sah_of(const CostLog& costs, Wait wait) const;
    bool has_degraded(const CostLog& costs) const;
    Compaction compaction_of(const HeldGeometry& held) const;
    std::vector<HeldGeometry*> held_geometries() const;  // each once, in push order
    AccelTraits accel_traits() const;
    SceneTraits scene_traits() const;
    void check_movable(const char* action) const;
    void warn_of_unusable_instances();
    const TraceProgram& variant_for(uint features, const TraceDesc& desc) const;
    const TraceProgram& program_for(const TraceDesc& desc) const;
    void check_desc(const AccelView& view, const TraceDesc& desc) const;
    void check_buffers(const TraceDesc& desc) const;
    void record_rays(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    Uints record_order(Commands& commands, const TraceDesc& desc) const;

    Context& context_;
    std::string name_;
    std::uint64_t id_;
    AccelOptions options_;
    std::unique_ptr<MeshStore> meshes_;
    InstanceArray instances_;
    std::unique_ptr<Refinement> refinement_;                   // null below Level::refined
    std::unique_ptr<SurfaceTables> surfaces_;                  // null if it keeps nothing
    mutable std::unique_ptr<SurfaceKernels> surface_kernels_;  // made by the first query of surfaces by the host
    mutable InstanceOwners owners_;
    std::unique_ptr<WorldBoundKernel> bound_;
    mutable SyncPoint bound_at_;           // when the last sync's bound is there; null: it was not requested
    mutable bool computes_bound_ = false;  // in each sync: it was requested, or transforms may be unusable
    mutable CostLog scene_costs_;          // the first query measures a top level in which nothing has moved
    double rebuild_ratio_ = default_rebuild_ratio;
    std::uint64_t scratch_budget_ = 64 << 20;
    std::map<std::uint64_t, PushedGeometry> pushed_;  // in push order: ids only grow
    std::size_t instance_count_ = 0;                  // of all of them
    Dirty dirty_ = Dirty::structure;
    // The next sync examines only these, or all instances if the structure changes.
    std::vector<std::weak_ptr<HeldGeometry>> edited_;
    std::set<std::uint64_t> edited_instances_;  // handles
    // Built geometries that may become smaller once the GPU tells.
    std::vector<std::weak_ptr<HeldGeometry>> uncompacted_;
    bool has_moved_ = false;  // something has moved after a build, so that builds allow refits
    std::uint64_t revision_ = 0;
    std::uint64_t edit_count_ = 0;
    std::unique_ptr<SceneTraits> traits_;                          // of the built scene
    mutable std::unique_ptr<PipelineVariants> pipeline_variants_;  // made by the first trace
    mutable std::unique_ptr<RaySort> ray_sort_;                    // made by the first that sorts
    SyncPoint synced_;
    uint warned_unusable_ = 0;
    std::unique_ptr<BuiltTlas> scene_;
    // The instances of that scene.
    std::size_t scene_count_ = 0;
    // Geometries erased or replaced since the last sync: its views still read them.
    std::vector<PushedGeometry> outdated_;
    std::vector<HeldGeometry> replaced_;
    std::unique_ptr<Commands> last_build_;
};

}  // namespace twinray
