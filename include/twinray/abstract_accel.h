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

// The records of one handle's instances on the device, for kernels that move them. Kernels may write object_to_world
// (12 floats at offset 0 of each record) and the custom index (lower 24 bits of the word at offset 48), and the mask
// (upper 8 bits) if the accelerator was made with AccelOptions::masks_on_device; they must leave the rest. A later edit
// of an instance by the host replaces what kernels wrote. Valid as long as revision() does not change.
struct InstanceRange {
    VkBuffer buffer = VK_NULL_HANDLE;
    std::uint64_t offset = 0;     // of the first record, in bytes
    Ref<InstanceRecord> records;  // its device address
    std::size_t count = 0;
};

// The contract that both accelerators fulfil. Edits only note changes; sync() is the only call that builds, and it
// never waits for the GPU. Wrong use throws Error naming the object, the value and the limit, and leaves the
// accelerator unchanged.
class AbstractAccel {
  public:
    virtual ~AbstractAccel();
    AbstractAccel(const AbstractAccel&) = delete;
    AbstractAccel& operator=(const AbstractAccel&) = delete;

    // Adds one geometry with one instance. The mesh is copied; the arrays of a SharedMesh are shared. An empty
    // mesh is allowed and never hit.
    AccelHandle push(const MeshView& mesh, const Transform& transform = {}, const InstanceOptions& options = {});
    // Adds one geometry with one instance per transform; options is empty or has one entry per transform.
    AccelHandle push(const MeshView& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // The same for boxes; only traces with a program can hit them.
    AccelHandle push(const BoxesView& boxes, const Transform& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const BoxesView& boxes, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // The same for a mesh in device memory, which the next sync reads there. Only its indices are checked: a triangle
    // with one out of range is inactive, and a later sync warns how many there are.
    AccelHandle push(const DeviceMesh& mesh, const Transform& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const DeviceMesh& mesh, std::span<const Transform> transforms,
                     std::span<const InstanceOptions> options = {});
    // Adds instances of the handle's geometry behind the existing ones and returns the index of the first new one.
    // Options as in push().
    std::size_t append_instances(AccelHandle handle, std::span<const Transform> transforms,
                                 std::span<const InstanceOptions> options = {});
    // Erases one instance; those behind it move up by one. Waits for the GPU if kernels may have moved the instances.
    // Throws Error while transforms from device memory are pending.
    void erase_instance(AccelHandle handle, std::size_t index);
    // Adds instances of the geometry of another handle. It is neither copied nor built again and lives as long as one
    // of its handles. A change through one handle (update, update_vertices) changes it for all.
    AccelHandle push_instances_of(AccelHandle handle, std::span<const Transform> transforms,
                                  std::span<const InstanceOptions> options = {});
    // Erases the handle and its instances. Returns false if it is dead already.
    bool erase(AccelHandle handle);
    // Replaces the mesh or the boxes for all instances of the handle.
    void update(AccelHandle handle, const MeshView& mesh);
    void update(AccelHandle handle, const BoxesView& boxes);
    // If the handle had a DeviceMesh of the same counts (and built in the same units: DeviceMesh::bounds), both without
    // attributes, the next sync rebuilds in the same memory and views stay valid: kernels can generate a new mesh for
    // each frame.
    void update(AccelHandle handle, const DeviceMesh& mesh);
    // Replaces the positions of all vertices of the handle's mesh; their number and the triangles stay. The next sync
    // refits the geometry in place: views stay valid. A triangle with a corner that is not finite, or without an area,
    // is inactive until it is moved back.
    void update_vertices(AccelHandle handle, std::span<const vec3> positions);
    // The same from device memory: 3 * count tightly packed floats, unchecked, which the next sync reads.
    void update_vertices(AccelHandle handle, Floats positions, std::size_t count);
    // Tells that kernels have moved vertices of a DeviceMesh in place: the next sync reads it again and refits.
    void mark_vertices_dirty(AccelHandle handle);

    // Change transforms; custom indices, masks and flags stay. update_transform() needs a handle with one instance,
    // update_transforms() one transform per instance. They throw with AccelOptions::can_move = false.
    void update_transform(AccelHandle handle, const Transform& transform);
    // Sets one transform for each instance of the handle.
    void update_transforms(AccelHandle handle, std::span<const Transform> transforms);
    // Sets the transform of one instance.
    void update_transform_at(AccelHandle handle, std::size_t index, const Transform& transform);
    // The same from device memory, read by the next sync and unchecked: an instance whose transform is singular or not
    // finite becomes inactive, and the accelerator warns how many there are.
    void update_transforms(AccelHandle handle, Ref<Transform> transforms, std::size_t count);
    // Returns the records that kernels may write; after mark_transforms_dirty(), the next sync reads them.
    InstanceRange instance_buffer(AccelHandle handle) const;
    // Tells that kernels have written to instance_buffer(): the next sync uses the new values.
    void mark_transforms_dirty(AccelHandle handle);
    // Sets the custom index, mask and flags of an instance; its transform stays, pending or not. Ends all views and the
    // ranges from instance_buffer(), as push() does.
    void update_options(AccelHandle handle, std::size_t index, const InstanceOptions& options);

    bool is_valid(AccelHandle handle) const;  // whether it names a pushed object that has not been erased
    // Waits for the GPU if kernels may have moved the instances.
    InstanceState get_instance(AccelHandle handle, std::size_t index) const;
    std::vector<InstanceState> get_instances(AccelHandle handle) const;  // all of them, ordered by index
    std::size_t n_instances() const;                                     // of all handles
    std::size_t n_instances(AccelHandle handle) const;                   // 0 for a dead handle
    std::size_t n_geometries() const;                    // a mesh or boxes of several handles count once
    std::size_t n_primitives(AccelHandle handle) const;  // triangles or boxes of its geometry; 0 for a dead handle
    std::vector<AccelHandle> handles() const;            // those alive, in push order
    // Returns the handle's mesh, as kernels have left it; an empty one for boxes. Waits if only the device has it, and
    // then needs work recorded by sync(Commands&) to be submitted.
    SharedMesh mesh(AccelHandle handle) const;

    // Builds what changed since the last sync and returns the point at which the GPU has built it; does nothing if
    // nothing changed. If only transforms and vertices changed, everything is refitted in place and views stay valid.
    // It never waits for the GPU: memory that in-flight work may still read is freed when the timeline has passed that
    // work.
    SyncPoint sync();
    // Records the same into commands, which may hold other work and must then be submitted: from here on the
    // accelerator relies on them. Work that uses the result must run after it; closest_hits() needs them submitted
    // before. If this throws, they must not be submitted (and CallerCommands::done must be reached without them).
    void sync(Commands& commands);
    // Returns whether geometries could go into less memory now (drivers' bottom levels can, once the GPU has built
    // them, until their vertices move). If so, the next sync moves them, as does every sync that has other work; views
    // stay valid. Without this call, a sync without other work does not, because it would have to ask each time.
    bool compact();
    // Returns the bytes of device memory that a sync may take for building geometries beyond what it keeps: they are
    // built in batches that fit, of at least one geometry, and batches reuse the same memory. Results do not depend on
    // it. Staging memory for the host's uploads comes on top. Default: 64 MiB.
    std::uint64_t scratch_budget() const;
    void set_scratch_budget(std::uint64_t bytes);  // for the syncs to come
    // Throws Error if edits are pending.
    AccelView view() const;
    // Counts the syncs that changed more than transforms and vertices: earlier views are stale.
    std::uint64_t revision() const;

    // Returns the box of the handle's geometry in object space; empty if nothing of it can be hit. Waits for the last
    // sync. Throws Error if edits are pending.
    Bounds object_bound(AccelHandle handle) const;
    // Returns a box around all live instances at the last sync: the box of each geometry under its transform, rounded
    // outward; empty if there are none. Waits for the last sync. Throws Error while edits wait for the first one.
    Bounds world_bound() const;
    // The same without waiting: nullopt while it is computed, which the first call starts; empty before the first sync.
    std::optional<Bounds> world_bound_if_ready() const;
    // The same on the device, for kernels that run after Context::last_submission() as it is after this call.
    Ref<WorldBound> world_bound_on_device() const;

    // Return the current quality of the trees: the areas of the boxes of all children, including leaves, over the area
    // of the root's box, a measure of the time that rays take (the surface area heuristic); 0 if the root's box has no
    // area. The GPU measures it in float32 with pairwise sums; its relative error is at most 1e-5. A driver's tree is
    // hidden: for HwTlas it is an estimate, the cost of the tree that halves the driver's input again and again. The
    // form without a handle measures the top level: syncs do so once something has moved, and before that the first
    // call does. The other form measures a geometry, from the first sync that follows update_vertices() of a built
    // geometry; for a DeviceMesh from its first sync; nullopt before. Both wait for the measurement.
    std::optional<double> sah() const;
    std::optional<double> sah(AccelHandle handle) const;
    // Return the latest measurement that the GPU has finished since the tree was last built; nullopt if there is none.
    // They neither wait nor start a measurement: before something has moved, only sah() gives one for the top level.
    std::optional<double> sah_if_ready() const;
    std::optional<double> sah_if_ready(AccelHandle handle) const;
    // A sync rebuilds instead of refitting once sah_if_ready() exceeds this ratio times its value at the last build;
    // addresses and views stay valid. At least 1, else Error; infinity: never.
    double rebuild_ratio() const;
    void set_rebuild_ratio(double ratio);  // for the syncs to come

    // Records the trace; later passes see the hits. Throws Error on a stale or foreign view.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc) const;
    // The same into own commands, in parts if one submission might take too long (see Pace). Also throws Error if
    // TraceDesc::indirect_count is set.
    void trace(Commands& commands, const AccelView& view, const TraceDesc& desc, Pace& pace) const;
    // Convenience for the host: syncs, uploads, traces, waits and downloads. Ignores the fields rays, hits, count,
    // query and occlusion_only of `desc`.
    std::vector<Hit> closest_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    // The same for any hit instead of the closest.
    std::vector<Hit> any_hits(std::span<const Ray> rays, const TraceDesc& desc = {});
    // Finds closest hits at the accelerator's own level, refined or certified; then computes t, u and v in float64 for
    // the ray in float64, with t within its interval. Hits are found with the ray rounded to float32, which misses
    // surfaces that are nearer to the ray, or to an end of the interval, than the rounding moves it.
    std::vector<HitExact> exact_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});
    // Returns the surface at each hit, as twinray/glsl/surface.glsl finds it; all fields are 0 for misses and boxes.
    // Waits, also for work recorded by sync(Commands&), which must be submitted. Needs AccelOptions::keeps_surfaces.
    // Throws Error for a hit that names nothing, and if edits are pending.
    std::vector<Surface> surfaces(std::span<const Ray> rays, std::span<const Hit> hits) const;
    // Returns a mesh attribute at each hit, interpolated; components that it lacks are 0, 0, 1. `missing` is returned
    // for a miss and for a mesh without the attribute. `name` is "normals", ..., or a name in MeshView::attributes.
    std::vector<vec4> attributes(std::string_view name, std::span<const Ray> rays, std::span<const Hit> hits,
                                 vec4 missing = {}) const;
    // Returns the number of an attribute for kernels. Throws Error naming it if no pushed mesh has had it.
    uint attribute_number(std::string_view name) const;
    // Returns the handle whose instance was hit. Throws Error for a miss and if edits are pending.
    AccelHandle handle_of(const Hit& hit) const;
    // Returns the index of the hit instance among those of handle_of(hit), from 0.
    std::size_t index_in_handle(const Hit& hit) const;
    // Returns AccelView::features without those that traces with this mask, cull and occlusion_only do not need: while
    // revision() does not change, kernels for such traces may be specialised for the result. Throws Error if edits are
    // pending.
    uint features_for(const TraceDesc& desc) const;
    // Waits until no program is left to compile in the background.
    void wait_for_programs() const;
    // Makes a trace program for this accelerator, specialised for traces that need no more than `features`.
    std::unique_ptr<TraceProgram> make_program(const TraceProgramCode& code, uint features = ~0u) const;

    // Returns what this accelerator supports on its device.
    Capability capability(Feature feature) const;
    // Throws Error, which names `kernel`, if the accelerator lacks Feature::kernel_queries.
    void check_kernel_queries(const std::string& kernel) const;
    std::vector<Capability> capabilities() const;  // of all features, in their order
    // Tells which of the two modules of a kernel with twinray/glsl/query.glsl fits.
    bool is_software() const;

    void wait_for_gpu();  // see Context::wait_for_gpu
    // Returns the GPU time per pass of the last sync() that built something into commands of its own; waits for it.
    std::vector<PassTiming> build_timings() const;
    // Returns the state at the last sync; memory that only older work may still read is not counted.
    MemoryUsage memory_usage() const;
    // Returns the memory that the next sync takes for unbuilt geometries and top levels: the exact size of structures,
    // except for meshes without a triangle that can be hit, and all scratch. Staging memory comes on top.
    BuildBytes memory_requirements() const;
    // The same as an upper bound for such meshes and so many instances: SwTlas takes less where triangles share edges.
    BuildBytes memory_requirements(std::span<const GeometrySize> geometries, std::size_t instance_count) const;

    const AccelOptions& options() const;  // the ones that it was made with
    Context& context() const;             // that it was made on
    const std::string& name() const;      // "SwTlas", "HwTlas", ...

    // Internal: the library's own parts use it.
    AccelBackend& backend() const { return *backend_; }

  protected:
    explicit AbstractAccel(std::unique_ptr<AccelBackend> backend);

  private:
    std::unique_ptr<AccelBackend> backend_;
};

// A kernel with twinray/glsl/query.glsl. Of the two modules that twinray_add_kernel() makes, it uses the one for this
// accelerator, specialised for what traces of its scene need, and specialises it again if an edit makes them need more.
template <class Args>
class QueryKernel {
  public:
    // `desc` has no spirv. The accelerator must outlive the kernel. Throws Error if kernels cannot trace it
    // (Feature::kernel_queries).
    QueryKernel(const AbstractAccel& accel, KernelDesc desc, std::span<const std::uint32_t> software,
                std::span<const std::uint32_t> hardware)
        : accel_(accel), desc_(std::move(desc)) {
        accel.check_kernel_queries(desc_.name);
        desc_.spirv = accel.is_software() ? software : hardware;
    }
    QueryKernel(const AbstractAccel&&, KernelDesc, std::span<const std::uint32_t>,
                std::span<const std::uint32_t>) = delete;

    // See Kernel::dispatch. Throws Error if edits are pending.
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
