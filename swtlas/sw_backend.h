// The implementation of SwTlas: trees that compute shaders build and traverse.
#pragma once

#include <functional>

#include "engine/accel/accel_backend.h"
#include "swtlas/build.h"
#include "swtlas/tree.h"

namespace twinray {

struct SavedGeometry;

class SwBackend final : public AccelBackend {
  public:
    explicit SwBackend(Context& context, const AccelOptions& options = {});

    Capability capability(Feature feature) const override {
        return SwTlas::capability_on(context().properties(), feature);
    }
    bool is_software() const override { return true; }

    // See SwTlas and swtlas/tree.h.
    void save(const std::filesystem::path& file) const;
    AccelHandle push_saved(Commands& commands, SavedGeometry&& saved);
    BuiltTree download_geometry(AccelHandle handle) const;
    BuiltTree download_scene() const;

  private:
    struct SwBuiltGeometry;
    struct SwBuiltTlas;
    struct HostMesh;
    struct Source;
    struct Batch;
    struct Needs;
    using Built = std::vector<std::unique_ptr<BuiltGeometry>>;
    Built build_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    Built refit_geometries(Commands& commands, std::span<const GeometryInput> inputs) override;
    BuildBytes geometry_bytes(std::span<const GeometrySize> geometries) const override;
    BuildBytes bytes_of(std::span<const Geometry* const> geometries) const override;
    BuildBytes scene_bytes(std::size_t count, std::size_t capacity) const override;
    static const PackedMesh& device_mesh(const GeometryInput& input);
    static uint leaf_count_of(const GeometryInput& input);
    static std::uint64_t source_bytes(const GeometryInput& input);
    static std::vector<Builder::Measured> measured(const Batch& batch, std::span<const BuildTree> trees);
    void record_batches(Commands& commands, std::span<const GeometryInput> inputs,
                        const std::function<void(const Batch&, const Buffer& scratch)>& record);
    void record_build(Commands& commands, const Batch& batch, const Buffer& scratch, Built& built);
    void record_refit(Commands& commands, const Batch& batch, const Buffer& scratch);
    static std::vector<Source> record_refit_sources(Commands& commands, const Batch& batch, const Buffer& scratch);
    SwGeometry block_of(const SwBuiltGeometry& built, Floats vertices, uint kind) const;
    static std::vector<Source> record_sources(Commands& commands, const Batch& batch, bool wants_leaves,
                                              const Buffer& scratch);
    static void record_vertices(Commands& commands, const Batch& batch, std::span<const Source> sources,
                                const Buffer& scratch, std::span<const SwBuiltGeometry* const> targets);
    std::unique_ptr<BuiltTlas> build_tlas(Commands& commands, const TlasInput& input,
                                          const BuiltTlas* current) override;
    void refit_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) override;
    void measure_tlas(Commands& commands, const TlasInput& input, const BuiltTlas& current) const override;
    void record_costs(Commands& commands, const TlasInput& input, const SwBuiltTlas& scene, bool is_build) const;
    float unit_of(std::span<const vec3> positions) const override { return software_unit(positions); }
    void prepare(Geometry& geometry) const override;
    std::unique_ptr<TraceProgram> create_program(const TraceProgramCode* code, uint features) const override;

    Builder builder_;
};

// The mesh in host memory that a tree is built from.
struct SwBackend::HostMesh {
    SharedArray<vec3> unwelded;  // empty if the geometry has welded vertices
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;

    explicit HostMesh(const Geometry& geometry)
        : positions(geometry.welded.positions), triangles(geometry.welded.triangles) {
        if (!geometry.welded.is_empty()) return;
        unwelded = geometry.built_positions();
        positions = unwelded, triangles = geometry.triangles;
    }
};

struct SwBackend::SwBuiltGeometry : BuiltGeometry {
    GeometryLayout layout;
    Buffer buffer;

    // `has_vertices`: of its mesh, in device memory already.
    SwBuiltGeometry(Context& context, const Geometry& geometry, bool has_vertices, Layout of_trees)
        : layout(layout_geometry(leaf_count_of(geometry), vertex_count_of(geometry, has_vertices), of_trees)),
          buffer(context, {.name = "SwTlas geometry '" + geometry.name + "'",
                           .bytes = layout.bytes,
                           .alignment = cache_line_bytes}) {
        bytes = layout.bytes;
    }
    static uint leaf_count_of(const Geometry& geometry) {
        return static_cast<uint>(geometry.leaves.empty() ? geometry.primitive_count() : geometry.leaves.size());
    }
    static std::size_t vertex_count_of(const Geometry& geometry, bool has_vertices) {
        if (geometry.leaves.empty() || has_vertices) return 0;
        return geometry.welded.is_empty() ? geometry.vertex_count() : geometry.welded.positions.size();
    }
    // Returns null if there are none.
    Ref<BvhNode> nodes() const { return part<BvhNode>(layout.node_count, layout.nodes); }
    Ref<BvhTriangle> triangles() const { return part<BvhTriangle>(layout.triangle_count, layout.triangles); }
    Ref<CompressedRecord> records() const { return part<CompressedRecord>(layout.record_count, layout.records); }
    Floats vertices() const { return {part<vec3>(layout.vertex_count, layout.vertices).address}; }

  private:
    template <class T>
    Ref<T> part(std::size_t count, std::uint64_t offset) const {
        return count ? buffer.ref<T>(offset) : Ref<T>{};
    }
};

}  // namespace twinray
