// SPDX-License-Identifier: MIT
// A driver's acceleration structures without HwTlas in between: builds, updates, copies, files and ray queries.
#pragma once

#include <string>

#include "engine/core/kernel.h"
#include "hwtlas/acceleration_structure.h"
#include "validation/conformance/driver_input.h"
#include "validation/conformance/misdeed.h"
#include "validation/conformance/query.h"
#include "validation/conformance/serialized.h"

namespace twinray::conformance {

// A structure, and what it was made of.
struct Bottom {
    AccelerationStructure structure;
    BottomInput input;
};
struct Top {
    AccelerationStructure structure;
    TopInput input;
    std::vector<std::uint64_t> bottoms;  // addresses that the instances refer to
};
struct DriverScene {
    std::vector<Bottom> bottoms;
    Top top;
};

class Driver {
  public:
    // Throws Error where the device has no ray queries.
    explicit Driver(Context& context, Misdeed misdeed = Misdeed::none);

    Context& context() const { return context_; }
    bool can_cull_primitives() const { return context_.properties().primitive_culling; }

    Bottom build(const BottomInput& input);
    // All by one command.
    std::vector<Bottom> build_together(std::span<const BottomInput> inputs);
    Top build(const TopInput& input, std::span<const Bottom> bottoms);
    Top build(const TopInput& input, const std::vector<std::uint64_t>& bottoms);
    DriverScene build(const SceneInput& scene);
    // Into the memory of another build, which took as many primitives or more.
    void rebuild(Bottom& bottom, const BottomInput& input);
    // In place.
    void update(Bottom& bottom, const BottomInput& input);
    void update(Top& top, const TopInput& input);
    // Into another structure; the source stays as it was.
    Bottom updated(const Bottom& source, const BottomInput& input);

    Bottom clone(const Bottom& source);
    Top clone(const Top& source);
    Bottom compacted(const Bottom& source);
    Top compacted(const Top& source);

    std::uint64_t serialized_bytes(const AccelerationStructure& structure);
    Serialized serialize(const AccelerationStructure& structure);
    bool is_compatible(const Serialized& file);
    Bottom deserialize(const Serialized& file, const BottomInput& input);
    Top deserialize(const Serialized& file, const TopInput& input, const std::vector<std::uint64_t>& bottoms);

    // `slots`: how many candidates of each shot are told.
    Traced trace(const Top& top, std::span<const Shot> shots, uint slots = 0);

  private:
    enum class Copy : std::uint8_t { clone, compact };
    AccelerationStructure new_structure(const char* name, const BuildInput& input);
    void record_build(Commands& commands, std::span<const BuildInput> inputs,
                      std::span<const AccelerationStructure* const> targets,
                      const AccelerationStructure* updated_from = nullptr);
    Bottom copied(const Bottom& source, Copy mode);
    Top copied(const Top& source, Copy mode);
    // What Misdeed::copies_in_part makes.
    Bottom shortened(BottomInput input);
    Top shortened(TopInput input, const std::vector<std::uint64_t>& bottoms);
    AccelerationStructure copy(const AccelerationStructure& source, VkAccelerationStructureTypeKHR type, Copy mode);
    AccelerationStructure deserialize(const Serialized& file, VkAccelerationStructureTypeKHR type);
    std::uint64_t property(const AccelerationStructure& structure, VkQueryType type);

    Context& context_;
    Misdeed misdeed_;
    std::size_t traces_ = 0;
    Kernel<QueryArgs> query_;
};

}  // namespace twinray::conformance
