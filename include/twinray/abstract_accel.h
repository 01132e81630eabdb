// SPDX-License-Identifier: MIT
// The contract of both accelerators: geometry and instances by handles, a sync that builds, views that trace.
#pragma once

#include <optional>
#include <utility>

#include <twinray/commands.h>
#include <twinray/device_mesh.h>
#include <twinray/trace.h>

namespace twinray {

class AccelBackend;
struct InstanceRecord;
struct WorldBound;

// The records of one handle's instances on the device, for kernels that move them. They may write object_to_world (12
// floats at offset 0 of each record) and the custom index (lower 24 bits of the word at offset 48); the mask (upper 8
// bits) where the accelerator was made with AccelOptions::masks_on_device; and must leave the rest. What the host edits
// of an instance later is the host's again. Valid as long as revision() does not change.
struct InstanceRange {
    VkBuffer buffer = VK_NULL_HANDLE;
    std::uint64_t offset = 0;     // of the first record, in bytes
    Ref<InstanceRecord> records;  // its device address
    std::size_t count = 0;
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
    // The same for a mesh in device memory, which the next sync reads there. What device memory holds nobody checks but
    // indices: a triangle with one out of range is inactive, and a later sync warns how many.
    AccelHandle push(const DeviceMesh& mesh, const Transform& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const DeviceMesh& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // More instances of the handle's geometry, behind those that it has; returns the index of the first of them.
    // Options as in push.
    std::size_t append_instances(AccelHandle handle, std::span<const Transform> transforms,
                                 std::span<const InstanceOptions> options = {});
    // Those behind it move up by one. Waits for the GPU if kernels may have moved the instances. Throws Error while
    // transforms from device memory are pending.
    void erase_instance(AccelHandle handle, std::size_t index);
    // Instances of the geometry of another handle, which is neither copied nor built again and lives as long as one of
    // its handles. What changes it through one (update, update_vertices) changes it for all.
    AccelHandle push_instances_of(AccelHandle handle, std::span<const Transform> transforms,
                                  std::span<const InstanceOptions> options = {});
    // False if the handle is dead already.
    bool erase(AccelHandle handle);
    // Another mesh, or other boxes, for all instances of the handle.
    void update(AccelHandle handle, const MeshView& mesh);
    void update(AccelHandle handle, const BoxesView& boxes);
    // Where the handle had a DeviceMesh of the same counts (and built in the same units: DeviceMesh::bounds), both
    // without attributes, the next sync rebuilds in the same memory and views stay valid: kernels can make a mesh anew
    // for each frame.
    void update(AccelHandle handle, const DeviceMesh& mesh);
    // New positions for the vertices of the handle's mesh, as many as it has; the triangles stay. The next sync refits
    // the geometry in place: views stay valid. A triangle with a corner that is not finite, or without an area, is
    // inactive until it is moved back.
    void update_vertices(AccelHandle handle, std::span<const vec3> positions);
    // The same from device memory, 3 * count tightly packed floats, read by the next sync. Nobody checks them.
    void update_vertices(AccelHandle handle, Floats positions, std::size_t count);
    // The caller's kernels have moved vertices of a DeviceMesh in place: the next sync reads it again and refits.
    void mark_vertices_dirty(AccelHandle handle);

    // Transforms; custom indices, masks and flags stay. update_transform wants a handle with exactly one instance,
    // update_transforms one transform per instance. AccelOptions::can_move = false forbids all that moves instances.
    void update_transform(AccelHandle handle, const Transform& transform);
    // One for each instance of the handle.
    void update_transforms(AccelHandle handle, std::span<const Transform> transforms);
    // Of one of its instances.
    void update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform);
    // The same from device memory, read by the next sync. Nobody checks what lies there: an instance whose transform is
    // singular or not finite becomes inactive, and the accelerator warns how many.
    void update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count);
    // The caller's kernels write into instance_buffer(), then mark_transforms_dirty() lets the next sync take it over.
    InstanceRange instance_buffer(AccelHandle handle) const;
    // What kernels wrote there counts from the next sync on.
    void mark_transforms_dirty(AccelHandle handle);
    // Another custom index, mask or flags for an instance, wherever it stands or is about to. Ends all views and what
    // instance_buffer() has given, as a push does.
    void update_options(AccelHandle handle, std::size_t index, const InstanceOptions& options);

    bool is_valid(AccelHandle handle) const;  // whether it names something that was not erased
    // Waits for the GPU if kernels may have moved the instances.
    InstanceState get_instance(AccelHandle handle, std::size_t index) const;
    std::vector<InstanceState> get_instances(AccelHandle handle) const;  // all of them, in the order of their indices
    std::size_t n_instances() const;                                     // of all handles
    std::size_t n_instances(AccelHandle handle) const;                   // 0 for a dead handle
    std::size_t n_geometries() const;                    // a mesh or boxes of several handles count once
    std::size_t n_primitives(AccelHandle handle) const;  // triangles or boxes of its geometry; 0 for a dead handle
    std::vector<AccelHandle> handles() const;            // those alive, in push order

    // Builds what changed since the last sync and returns the point at which the GPU has built it; a clean
    // accelerator does nothing. Where only transforms and vertices changed, everything is refitted in place and views
    // stay valid.
    // It never waits for the GPU: what in-flight work may still read is freed when the timeline has passed it.
    SyncPoint sync();
    // The same into commands that hold other work, too, which must then be submitted: from here on the accelerator
    // counts on them. Whatever uses the result must run after it; closest_hits() wants them submitted before. If this
    // throws, they must not be submitted (and CallerCommands::done be reached without it).
    void sync(Commands& commands);
    // Whether geometries could go into less memory now (bottom levels of drivers can, once the GPU has built them,
    // until their vertices move). If so the next sync moves them, as every sync does that has other work, too; views
    // stay valid. A clean accelerator does not do so by itself: it would have to ask in each sync.
    bool compact();
    // Bytes of device memory that a sync may take for building geometries beyond what it keeps: they are built in
    // batches that fit, of one at least, and batches use the same memory one after the other. Results do not depend on
    // it. What the host uploads is staged on top. Default: 64 MiB.
    std::uint64_t scratch_budget() const;
    void set_scratch_budget(std::uint64_t bytes);  // for the syncs to come
    // Throws Error if edits are pending.
    AccelView view() const;
    // Counts the syncs that changed more than transforms and vertices: views of before are stale.
    std::uint64_t revision() const;

    // The box of the handle's geometry, in object space; empty where nothing of it could be hit. Waits for the last
    // sync. Throws Error if edits are pending.
    Bounds object_bound(AccelHandle handle) const;
    // A box around all live instances at the last sync: the box of each geometry under its transform, rounded outward.
    // Empty for an empty accelerator. Waits for the last sync. Throws Error while edits wait for the first one.
    Bounds world_bound() const;
    // The same without waiting: nothing while it is computed, which the first call begins; empty before the first sync.
    std::optional<Bounds> world_bound_if_ready() const;
    // The same on the device, for kernels that run after Context::last_submission() as it is after this call.
    Ref<WorldBound> world_bound_on_device() const;

    // How good the trees still are: the areas of the boxes of all children, leaves too, over the area of the root's
    // box, a measure of the time that rays take (the surface area heuristic); 0 where the root's box has no area.
    // Measured by the GPU in float32, with pairwise sums: right to 1e-5 of itself. What a driver builds is hidden: for
    // HwTlas it is an estimate, the cost of the tree that halves the driver's input again and again. The form without a
    // handle is about the top level: syncs measure it once something has moved, and the first question before that
    // does. The other is about a geometry, measured from the first sync on that follows update_vertices() of what is
    // built, a DeviceMesh's from its first sync: nothing before. They wait for what measures.
    std::optional<double> sah() const;
    std::optional<double> sah(AccelHandle handle) const;
    // The latest measure that the GPU has done since the tree was last built; nothing while it has none. They do not
    // wait, and start no measure: before something has moved the top level has none but for sah().
    std::optional<double> sah_if_ready() const;
    std::optional<double> sah_if_ready(AccelHandle handle) const;
    // A sync rebuilds what it would refit where sah_if_ready() has grown past this ratio to what it was at the last
    // build; addresses and views stay. At least 1; infinity: never. Throws Error otherwise.
    double rebuild_ratio() const;
    void set_rebuild_ratio(double ratio);  // for the syncs to come

    // Records the trace; the hits are visible to later passes. Throws Error on a stale or foreign view.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    // The same in parts, if one submission might take too long (see Pace), into own commands. Throws Error where
    // TraceDesc::indirect_count is set, too.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const;
    // Host convenience: syncs, uploads, traces, waits and downloads. Of `desc` all counts but rays, hits, count, query
    // and occlusion_only.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    // The same for whichever hit is found first.
    std::vector<Hit> any_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    // Closest hits at the accelerator's own level, which must be refined or certified; then t, u and v of what each met
    // in float64, of the ray in float64: t is within its interval. What is met is found with the ray rounded to
    // float32, which misses what lies nearer to it, or to an end of the interval, than that moves it.
    std::vector<HitExact> exact_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});
    // What lies where each ray met what its hit names, as twinray/glsl/surface.glsl finds it; of misses and boxes
    // all is 0. Waits, for what sync(Commands&) has recorded too, which must be submitted. Wants
    // AccelOptions::keeps_surfaces. Throws Error for a hit that names nothing, and if edits are pending.
    std::vector<Surface> surfaces(std::span<const Ray> rays, std::span<const Hit> hits) const;
    // An attribute of the meshes there, interpolated, with 0, 0, 1 for components that it lacks; `missing` where a mesh
    // has none, and for a miss. By name: "normals", ..., or of MeshView::attributes.
    std::vector<vec4> attributes(std::string_view name, std::span<const Ray> rays, std::span<const Hit> hits,
                                 vec4 missing = {}) const;
    // For kernels. Throws Error naming it where no mesh that was pushed has had it.
    uint attribute_number(std::string_view name) const;
    // Whose instance was hit, and which of its instances. Throws Error for a miss and if edits are pending.
    AccelHandle handle_of(const Hit& hit) const;
    // Counts from 0 among the instances of handle_of(hit).
    std::size_t index_in_handle(const Hit& hit) const;
    // AccelView::features without what traces with this mask, cull and occlusion_only do not need: as long as
    // revision() does not change, kernels that ask for nothing else may be specialised for it. Throws Error if edits
    // are pending.
    uint features_for(const TraceDesc& desc) const;
    // Until no program is left to compile in the background.
    void wait_for_programs() const;
    // A trace program for this accelerator, specialised for traces that need no more than `features`.
    std::unique_ptr<TraceProgram> make_program(const TraceProgramCode& code, uint features = ~0u) const;

    // What this accelerator can do on its device.
    Capability capability(Feature feature) const;
    // Throws Error, which names `kernel`, where the accelerator lacks Feature::kernel_queries.
    void check_kernel_queries(const std::string& kernel) const;
    std::vector<Capability> capabilities() const;  // of all features, in their order
    // Which of the two modules of a kernel with twinray/glsl/query.glsl fits.
    bool is_software() const;

    void wait_for_gpu();  // as Context::wait_for_gpu
    // GPU time per pass of the last sync() that built something into commands of its own; waits for it.
    std::vector<PassTiming> build_timings() const;
    // As of the last sync; what older work may still read is not counted.
    MemoryUsage memory_usage() const;
    // What the next sync will take for geometries and a top level that are not built yet: exactly what the structures
    // will be, but for meshes with nothing that could be hit, and all scratch. What the host uploads is staged on top.
    BuildBytes memory_requirements() const;
    // The same, at most, of such meshes and so many instances: SwTlas takes less where triangles share edges.
    BuildBytes memory_requirements(std::span<const GeometrySize> geometries, std::size_t instance_count) const;

    const AccelOptions& options() const;  // those that it was made with
    Context& context() const;             // that it was made on
    const std::string& name() const;      // "SwTlas", "HwTlas", ...

    // What the library itself needs of it.
    AccelBackend& backend() const { return *backend_; }

  protected:
    explicit AbstractAccel(std::unique_ptr<AccelBackend> backend);

  private:
    std::unique_ptr<AccelBackend> backend_;
};

// A kernel with twinray/glsl/query.glsl, of the two modules that twinray_add_kernel() makes the one for this
// accelerator, specialised for what traces of its scene need: again where an edit has made that more.
template <class Args>
class QueryKernel {
  public:
    // `desc` without spirv. The accelerator must outlive the kernel. Throws Error where kernels cannot trace it
    // (Feature::kernel_queries).
    QueryKernel(const AbstractAccel& accel, KernelDesc desc, std::span<const std::uint32_t> software,
                std::span<const std::uint32_t> hardware)
        : accel_(accel), desc_(std::move(desc)) {
        accel.check_kernel_queries(desc_.name);
        desc_.spirv = accel.is_software() ? software : hardware;
    }
    QueryKernel(const AbstractAccel&&, KernelDesc, std::span<const std::uint32_t>,
                std::span<const std::uint32_t>) = delete;

    // As Kernel::dispatch. Throws Error if edits are pending.
    void dispatch(Commands& commands, const Args& args, std::uint64_t count, VkDescriptorSet images = VK_NULL_HANDLE) {
        const AccelView view = accel_.view();
        if (!kernel_ || (view.features & ~features_) != 0) {
            KernelDesc desc = desc_;
            desc.constants.push_back(view.features_constant());
            kernel_.emplace(accel_.context(), desc);
            features_ = view.features;
        }
        kernel_->dispatch(commands, args, count, images);
    }

  private:
    const AbstractAccel& accel_;
    KernelDesc desc_;
    uint features_ = 0;
    std::optional<Kernel<Args>> kernel_;
};

}  // namespace twinray
