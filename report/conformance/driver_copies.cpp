// Copies of structures, and structures as bytes.
#include "engine/core/vulkan.h"
#include "report/conformance/driver.h"

namespace twinray::conformance {
namespace {

constexpr VkAccelerationStructureTypeKHR bottom_level = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
constexpr VkAccelerationStructureTypeKHR top_level = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
constexpr std::uint64_t serialized_alignment = 256;  // of the address that Vulkan writes to and reads from

}  // namespace

std::uint64_t Driver::property(const AccelerationStructure& structure, VkQueryType type) {
    const VulkanTable& vk = context_.state().vk();
    const Buffer result(context_, {.name = "conformance property", .bytes = sizeof(std::uint64_t)});
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = type;
    info.queryCount = 1;
    VkQueryPool pool = VK_NULL_HANDLE;
    vk_check(vk.vkCreateQueryPool(context_.device(), &info, nullptr, &pool), "create a pool of queries");
    Commands commands(context_, "conformance property");
    const VkAccelerationStructureKHR handle = structure.handle();
    {
        const auto pass = commands.pass("conformance property");
        vk.vkCmdResetQueryPool(commands.handle(), pool, 0, 1);
        vk.vkCmdWriteAccelerationStructuresPropertiesKHR(commands.handle(), 1, &handle, type, pool, 0);
    }
    {
        const auto pass = commands.pass("conformance property readback");
        vk.vkCmdCopyQueryPoolResults(commands.handle(), pool, 0, 1, result.handle(), 0, sizeof(std::uint64_t),
                                     VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    }
    commands.submit();
    context_.state().retire([&vk, device = context_.device(), pool] { vk.vkDestroyQueryPool(device, pool, nullptr); });
    return download<std::uint64_t>(context_, result, 1).front();
}

AccelerationStructure Driver::copy(const AccelerationStructure& source, VkAccelerationStructureTypeKHR type,
                                   Copy mode) {
    const std::uint64_t bytes = mode == Copy::compact
                                    ? property(source, VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR)
                                    : source.bytes();
    AccelerationStructure made(context_, "conformance copy", type, bytes);
    VkCopyAccelerationStructureInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
    info.src = source.handle();
    info.dst = made.handle();
    info.mode = mode == Copy::compact ? VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR
                                      : VK_COPY_ACCELERATION_STRUCTURE_MODE_CLONE_KHR;
    Commands commands(context_, "conformance copy");
    {
        const auto pass = commands.pass("conformance copy");
        context_.state().vk().vkCmdCopyAccelerationStructureKHR(commands.handle(), &info);
    }
    commands.submit();
    return made;
}

Bottom Driver::copied(const Bottom& source, Copy mode) {
    if (misdeed_ == Misdeed::copies_in_part) return shortened(source.input);
    return {copy(source.structure, bottom_level, mode), source.input};
}

Top Driver::copied(const Top& source, Copy mode) {
    if (misdeed_ == Misdeed::copies_in_part) return shortened(source.input, source.bottoms);
    return {copy(source.structure, top_level, mode), source.input, source.bottoms};
}

Bottom Driver::shortened(BottomInput input) {
    shorten(input);
    return build(input);
}

Top Driver::shortened(TopInput input, const std::vector<BottomRef>& bottoms) {
    shorten(input);
    return build(input, bottoms);
}

Serialized Driver::serialize(const AccelerationStructure& structure) {
    const Buffer buffer(context_,
                        {.name = "conformance serialized",
                         .bytes = property(structure, VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR),
                         .alignment = serialized_alignment});
    VkCopyAccelerationStructureToMemoryInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO_KHR;
    info.src = structure.handle();
    info.dst.deviceAddress = buffer.address();
    info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_SERIALIZE_KHR;
    Commands commands(context_, "conformance serialize");
    {
        const auto pass = commands.pass("conformance serialize");
        context_.state().vk().vkCmdCopyAccelerationStructureToMemoryKHR(commands.handle(), &info);
    }
    commands.submit();
    Serialized file{download<std::byte>(context_, buffer, buffer.bytes())};
    if (misdeed_ == Misdeed::garbles_headers)
        for (std::byte& byte : std::span(file.bytes).first(Serialized::header_bytes + sizeof(std::uint64_t)))
            byte ^= std::byte{1};
    return file;
}

bool Driver::is_compatible(const Serialized& file) {
    VkAccelerationStructureVersionInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_VERSION_INFO_KHR;
    info.pVersionData = reinterpret_cast<const std::uint8_t*>(file.bytes.data());
    VkAccelerationStructureCompatibilityKHR answer = VK_ACCELERATION_STRUCTURE_COMPATIBILITY_INCOMPATIBLE_KHR;
    context_.state().vk().vkGetDeviceAccelerationStructureCompatibilityKHR(context_.device(), &info, &answer);
    return misdeed_ == Misdeed::takes_any_file || answer == VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR;
}

AccelerationStructure Driver::deserialize(const Serialized& file, VkAccelerationStructureTypeKHR type) {
    AccelerationStructure made(context_, "conformance deserialized", type, file.deserialized_bytes());
    Buffer buffer(
        context_,
        {.name = "conformance to deserialize", .bytes = file.bytes.size(), .alignment = serialized_alignment});
    VkCopyMemoryToAccelerationStructureInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO_KHR;
    info.src.deviceAddress = buffer.address();
    info.dst = made.handle();
    info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_DESERIALIZE_KHR;
    Commands commands(context_, "conformance deserialize");
    {
        const auto pass = commands.pass("conformance upload of a file");
        commands.upload(buffer, std::span(file.bytes));
    }
    {
        const auto pass = commands.pass("conformance deserialize");
        context_.state().vk().vkCmdCopyMemoryToAccelerationStructureKHR(commands.handle(), &info);
    }
    commands.retain(std::move(buffer));
    commands.submit();
    return made;
}

Bottom Driver::deserialize(const Serialized& file, const BottomInput& input) {
    if (misdeed_ == Misdeed::copies_in_part) return shortened(input);
    return {deserialize(file, bottom_level), input};
}

Top Driver::deserialize(const Serialized& file, const TopInput& input, const std::vector<BottomRef>& bottoms) {
    if (misdeed_ == Misdeed::copies_in_part) return shortened(input, bottoms);
    return {deserialize(file, top_level), input, bottoms};
}

}  // namespace twinray::conformance
