// A driver's acceleration structures without HwTlas in between: builds, updates, copies, files, ray queries, pipelines.
#pragma once

#include <cstddef>

#include "engine/core/commands.h"
#include "engine/core/kernel.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/ray_tracing_pipeline.h"
#include "report/conformance/inputs.h"
#include "report/frame/devices.h"

namespace twinray::conformance {

using frame::Backend;

// Returns the bytes of a geometry's vertices in its format, including the padding, the vertices before the first, and
// as many after.
std::vector<std::byte> encoded_vertices(const GeometryInput& geometry);
std::vector<std::byte> encoded_indices(const GeometryInput& geometry);
std::vector<std::byte> encoded_boxes(const GeometryInput& geometry);
std::uint32_t vertex_stride(const GeometryInput& geometry);

// The arguments of vkCmdBuildAccelerationStructuresKHR for one structure.
struct BuildInput {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    std::vector<std::uint32_t> counts;  // of primitives
    VkBuildAccelerationStructureFlagsKHR flags = 0;
    VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
};

// A bottom level as instances refer to it.
struct BottomRef {
    std::uint64_t address = 0;
    bool holds_boxes = false;
};

// Uploads in its own passes; the buffers live as long as the commands need them.
BuildInput upload(Commands& commands, const BottomInput& input);
BuildInput upload(Commands& commands, const TopInput& input, const std::vector<BottomRef>& bottoms);

// The bytes that vkCmdCopyAccelerationStructureToMemoryKHR writes, on the host.
struct Serialized {
    std::vector<std::byte> bytes;

    std::span<const std::uint8_t, VK_UUID_SIZE> driver_uuid() const;
    std::uint64_t serialized_bytes() const { return word(0); }
    std::uint64_t deserialized_bytes() const { return word(1); }
    std::uint64_t handle_count() const { return word(2); }
    void set_handles(std::span<const std::uint64_t> addresses);  // replaces the addresses of bottom levels
    std::vector<std::uint64_t> handles() const;

    static constexpr std::size_t header_bytes = 2 * VK_UUID_SIZE;  // before the numbers

  private:
    std::uint64_t word(std::size_t index) const;
};

// A structure and the input that it was built from.
struct Bottom {
    AccelerationStructure structure;
    BottomInput input;

    BottomRef ref() const;
};
struct Top {
    AccelerationStructure structure;
    TopInput input;
    std::vector<BottomRef> bottoms;  // to which the instances refer
};
struct DriverScene {
    std::vector<Bottom> bottoms;
    Top top;
};

class Driver {
  public:
    // Throws Error if the device cannot trace in this way.
    explicit Driver(Context& context, Backend way = Backend::ray_query);

    // Sets the misdeed of all later calls; without one, the driver is as it is.
    void behave_as(Misdeed misdeed) { misdeed_ = misdeed; }

    Context& context() const { return context_; }
    bool can_cull_primitives() const { return context_.properties().primitive_culling; }

    Bottom build(const BottomInput& input);
    // Builds all of them by one command.
    std::vector<Bottom> build_together(std::span<const BottomInput> inputs);
    Top build(const TopInput& input, std::span<const Bottom> bottoms);
    Top build(const TopInput& input, const std::vector<BottomRef>& bottoms);
    DriverScene build(const SceneInput& scene);
    // Builds into the memory of another build, which took as many primitives or more.
    void rebuild(Bottom& bottom, const BottomInput& input) { rebuild(bottom, input, "conformance rebuild", false); }
    // Updates in place.
    void update(Bottom& bottom, const BottomInput& input) { rebuild(bottom, input, "conformance update", true); }
    void update(Top& top, const TopInput& input);
    // Updates into another structure; the source stays as it was.
    Bottom updated(const Bottom& source, const BottomInput& input);

    enum class Copy : std::uint8_t { clone, compact };
    Bottom copied(const Bottom& source, Copy mode);
    Top copied(const Top& source, Copy mode);

    Serialized serialize(const AccelerationStructure& structure);
    bool is_compatible(const Serialized& file);
    Bottom deserialize(const Serialized& file, const BottomInput& input);
    Top deserialize(const Serialized& file, const TopInput& input, const std::vector<BottomRef>& bottoms);

    // `slots`: the number of candidates that are reported for each shot.
    Traced trace(const Top& top, std::span<const Shot> shots, uint slots = 0);

  private:
    // Returns the input in the form that the driver needs: a pipeline's instances choose their hit record.
    TopInput told(const TopInput& input, const std::vector<BottomRef>& bottoms) const;
    AccelerationStructure new_structure(const char* name, const BuildInput& input);
    void record_build(Commands& commands, std::span<const BuildInput> inputs,
                      std::span<const AccelerationStructure* const> targets,
                      const AccelerationStructure* updated_from = nullptr);
    // Records the build of one structure and submits.
    void submit_build(Commands& commands, const BuildInput& input, const AccelerationStructure& target,
                      const AccelerationStructure* updated_from = nullptr);
    void rebuild(Bottom& bottom, const BottomInput& input, const char* name, bool is_update);
    // Returns the result of Misdeed::copies_in_part.
    Bottom shortened(BottomInput input);
    Top shortened(TopInput input, const std::vector<BottomRef>& bottoms);
    AccelerationStructure copy(const AccelerationStructure& source, VkAccelerationStructureTypeKHR type, Copy mode);
    AccelerationStructure deserialize(const Serialized& file, VkAccelerationStructureTypeKHR type);
    std::uint64_t property(const AccelerationStructure& structure, VkQueryType type);

    Context& context_;
    Misdeed misdeed_ = Misdeed::none;
    std::size_t traces_ = 0;
    // Only one of these is set. In a pipeline, candidates come up in any-hit and intersection shaders; instances of
    // triangles use its first hit record, instances of boxes the second.
    std::unique_ptr<Kernel<QueryArgs>> query_;
    std::unique_ptr<RayTracingPipeline> pipeline_;
};

}  // namespace twinray::conformance
