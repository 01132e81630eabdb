// SPDX-License-Identifier: MIT
// A driver's acceleration structures without HwTlas in between: builds, updates, copies, files, ray queries, pipelines.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/kernel.h"
#include "hwtlas/acceleration_structure.h"
#include "hwtlas/ray_tracing_pipeline.h"
#include "report/conformance/driver_input.h"
#include "report/conformance/misdeed.h"
#include "report/conformance/query.h"
#include "report/frame/devices.h"

namespace twinray::conformance {

using frame::Backend;

// The bytes that vkCmdCopyAccelerationStructureToMemoryKHR writes, on the host.
struct Serialized {
    std::vector<std::byte> bytes;

    std::span<const std::uint8_t, VK_UUID_SIZE> driver_uuid() const;
    std::uint64_t serialized_bytes() const { return word(0); }
    std::uint64_t deserialized_bytes() const { return word(1); }
    std::uint64_t handle_count() const { return word(2); }
    void set_handles(std::span<const std::uint64_t> addresses);  // of bottom levels, which the file's are replaced by
    std::vector<std::uint64_t> handles() const;

    static constexpr std::size_t header_bytes = 2 * VK_UUID_SIZE;  // before the numbers

  private:
    std::uint64_t word(std::size_t index) const;
};

// A structure, and what it was made of.
struct Bottom {
    AccelerationStructure structure;
    BottomInput input;

    BottomRef ref() const;
};
struct Top {
    AccelerationStructure structure;
    TopInput input;
    std::vector<BottomRef> bottoms;  // that the instances refer to
};
struct DriverScene {
    std::vector<Bottom> bottoms;
    Top top;
};

class Driver {
  public:
    // Throws Error where the device has no such way.
    explicit Driver(Context& context, Backend way = Backend::ray_query);

    // From now on; none is how the driver is.
    void behave_as(Misdeed misdeed) { misdeed_ = misdeed; }

    Context& context() const { return context_; }
    bool can_cull_primitives() const { return context_.properties().primitive_culling; }

    Bottom build(const BottomInput& input);
    // All by one command.
    std::vector<Bottom> build_together(std::span<const BottomInput> inputs);
    Top build(const TopInput& input, std::span<const Bottom> bottoms);
    Top build(const TopInput& input, const std::vector<BottomRef>& bottoms);
    DriverScene build(const SceneInput& scene);
    // Into the memory of another build, which took as many primitives or more.
    void rebuild(Bottom& bottom, const BottomInput& input) { rebuild(bottom, input, "conformance rebuild", false); }
    // In place.
    void update(Bottom& bottom, const BottomInput& input) { rebuild(bottom, input, "conformance update", true); }
    void update(Top& top, const TopInput& input);
    // Into another structure; the source stays as it was.
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
    // In the form that the driver needs: a pipeline's instances choose their hit record.
    TopInput told(const TopInput& input, const std::vector<BottomRef>& bottoms) const;
    AccelerationStructure new_structure(const char* name, const BuildInput& input);
    void record_build(Commands& commands, std::span<const BuildInput> inputs,
                      std::span<const AccelerationStructure* const> targets,
                      const AccelerationStructure* updated_from = nullptr);
    // Records the build of one structure and submits.
    void submit_build(Commands& commands, const BuildInput& input, const AccelerationStructure& target,
                      const AccelerationStructure* updated_from = nullptr);
    void rebuild(Bottom& bottom, const BottomInput& input, const char* name, bool is_update);
    // The result of Misdeed::copies_in_part.
    Bottom shortened(BottomInput input);
    Top shortened(TopInput input, const std::vector<BottomRef>& bottoms);
    AccelerationStructure copy(const AccelerationStructure& source, VkAccelerationStructureTypeKHR type, Copy mode);
    AccelerationStructure deserialize(const Serialized& file, VkAccelerationStructureTypeKHR type);
    std::uint64_t property(const AccelerationStructure& structure, VkQueryType type);

    Context& context_;
    Misdeed misdeed_ = Misdeed::none;
    std::size_t traces_ = 0;
    // One of these. In a pipeline candidates come up in any-hit and intersection shaders; instances of triangles take
    // its first hit record, those of boxes the second.
    std::unique_ptr<Kernel<QueryArgs>> query_;
    std::unique_ptr<RayTracingPipeline> pipeline_;
};

}  // namespace twinray::conformance
