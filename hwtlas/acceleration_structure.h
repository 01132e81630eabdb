// The driver's acceleration structures: objects, sizes, builds, and copies into the memory that they finally need.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/commands.h"

namespace twinray {

// A VkAccelerationStructureKHR with its storage. Move-only; destroyed after all work submitted so far.
class AccelerationStructure {
  public:
    AccelerationStructure() = default;
    AccelerationStructure(Context& context, const std::string& name, VkAccelerationStructureTypeKHR type,
                          std::uint64_t bytes);
    ~AccelerationStructure();
    AccelerationStructure(AccelerationStructure&& other) noexcept;
    AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

    VkAccelerationStructureKHR handle() const { return handle_; }
    std::uint64_t address() const { return address_; }  // 0 for a default-constructed one
    std::uint64_t bytes() const { return storage_.bytes(); }

  private:
    Context* context_ = nullptr;
    Buffer storage_;
    VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
    std::uint64_t address_ = 0;
};

// One structure to be built from one geometry.
struct StructureBuild {
    std::string name;
    VkAccelerationStructureTypeKHR type;
    VkAccelerationStructureGeometryKHR geometry;
    std::uint32_t primitive_count;
    VkBuildAccelerationStructureFlagsKHR flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
};

// Describes one, of opaque geometry, but for the geometry's data.
StructureBuild structure_build(const std::string& name, VkAccelerationStructureTypeKHR type, VkGeometryTypeKHR geometry,
                               std::size_t primitive_count);

// Returns the memory that a build of up to primitive_count primitives takes.
VkAccelerationStructureBuildSizesInfoKHR sizes_of(const Context& context, const StructureBuild& build);
Buffer make_build_scratch(Context& context, const std::string& name, std::uint64_t bytes);

enum class BuildMode : std::uint8_t { build, update };

// A build into existing memory. update: the last build allowed that, and had as many primitives.
struct StructureWork {
    StructureBuild build;
    BuildMode mode;
    const AccelerationStructure* target;
};

// Returns the scratch memory that it takes, a multiple of the alignment that the device wants.
std::uint64_t scratch_bytes_of(const Context& context, const StructureWork& work);
// Builds all of them with one command in one pass called `pass_name`, their scratch one after the other from the
// address `scratch` on, which make_build_scratch() aligns. The geometries' data must have been written by earlier
// passes.
void record_builds(Commands& commands, const std::string& pass_name, std::span<const StructureWork> work,
                   std::uint64_t scratch);
// Creates the structures and builds them, in batches whose scratch fits into `budget`.
std::vector<AccelerationStructure> build_structures(Commands& commands, const std::string& pass_name,
                                                    std::span<const StructureBuild> builds, std::uint64_t budget);

// The bytes that structures of one build need at least, queried from the GPU when they were built.
class CompactedSizes {
  public:
    // Records the query in a pass of its own. The builds allowed compaction and are in earlier passes.
    CompactedSizes(Commands& commands, std::span<const AccelerationStructure* const> structures);
    ~CompactedSizes();
    CompactedSizes(const CompactedSizes&) = delete;
    CompactedSizes& operator=(const CompactedSizes&) = delete;

    // Returns the bytes for the structure at `index`; nullopt until the GPU reaches `built`, the commands' end.
    std::optional<std::uint64_t> of(std::size_t index, SyncPoint built);
    // The same once the query is done.
    std::uint64_t bytes_of(std::size_t index) const;

  private:
    Context& context_;
    Buffer bytes_;  // a word each, copied by the GPU: some drivers let vkGetQueryPoolResults wait for the whole queue
    VkQueryPool queries_ = VK_NULL_HANDLE;
    bool is_told_ = false;
};

// Records a copy of `bytes` bytes, in the caller's pass.
AccelerationStructure record_compaction(Commands& commands, const std::string& name,
                                        const AccelerationStructure& structure, std::uint64_t bytes);

}  // namespace twinray
