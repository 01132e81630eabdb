// SPDX-License-Identifier: MIT
#include "engine/core/commands.h"

#include <utility>

#include "engine/core/error.h"

namespace twinray {
namespace {

void check_range(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, const char* action) {
    if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
        fail("buffer '", buffer.name(), "': ", action, " of ", bytes, " bytes at ", offset, " exceeds its ",
             buffer.bytes(), " bytes");
}

}  // namespace

Commands::Pass::Pass(Commands& commands, const std::string& name) : commands_(commands) { commands_.begin_pass(name); }

Commands::Pass::~Pass() {
    Commands& c = commands_;
    c.write_timestamp(2 * c.parts_.back().passes.size() - 1);
    c.end_pass();
    if (c.context_.vk().vkCmdEndDebugUtilsLabelEXT) c.context_.vk().vkCmdEndDebugUtilsLabelEXT(c.handle());
}

void Commands::begin_pass(const std::string& name) {
    if (in_pass_)
        fail("commands '", name_, "': pass '", name, "' starts inside pass '", parts_.back().passes.back().name, "'");
    if (is_ended_) fail("commands '", name_, "': pass '", name, "' recorded after submit");
    if (is_part_full()) begin_part();
    in_pass_ = true;
    parts_.back().passes.push_back({name});
    if (context_.vk().vkCmdBeginDebugUtilsLabelEXT) {
        VkDebugUtilsLabelEXT label{};
        label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
        label.pLabelName = name.c_str();
        context_.vk().vkCmdBeginDebugUtilsLabelEXT(handle(), &label);
    }
    write_timestamp(2 * parts_.back().passes.size() - 2);
}

void Commands::end_pass() {
    barrier();
    in_pass_ = false;
}

void Commands::barrier() {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = consumer_access_;
    context_.vk().vkCmdPipelineBarrier(handle(), context_.stages(), context_.stages() | consumer_stages_, 0, 1,
                                       &barrier, 0, nullptr, 0, nullptr);
}

void Commands::upload(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    const Piece piece{offset, data};
    upload_pieces(target, std::span(&piece, 1));
}

void Commands::write_bytes(const Buffer& target, std::uint64_t offset, std::span<const std::byte> data) {
    check_range(target, offset, data.size(), "write");
    context_.vk().vkCmdUpdateBuffer(handle(), target.handle(), offset, data.size(), data.data());
}

void Commands::upload_pieces(const Buffer& target, std::span<const Piece> pieces) {
    std::vector<VkBufferCopy> regions;
    std::uint64_t bytes = 0;
    for (const Piece& piece : pieces) {
        if (piece.data.empty()) continue;
        check_range(target, piece.offset, piece.data.size(), "upload");
        regions.push_back({bytes, piece.offset, piece.data.size()});
        bytes += piece.data.size();
    }
    if (regions.empty()) return;
    Buffer staging(context_, {.name = "staging for " + target.name(), .bytes = bytes, .memory = Memory::upload});
    std::byte* next = staging.mapped();
    for (const Piece& piece : pieces) {
        if (piece.data.empty()) continue;
        std::memcpy(next, piece.data.data(), piece.data.size());
        next += piece.data.size();
    }
    context_.vk().vkCmdCopyBuffer(handle(), staging.handle(), target.handle(),
                                  static_cast<std::uint32_t>(regions.size()), regions.data());
    keep(std::move(staging));
}

void Commands::copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
                    std::uint64_t bytes) {
    if (bytes == 0) return;
    check_range(from, from_offset, bytes, "copy");
    check_range(to, to_offset, bytes, "copy");
    const VkBufferCopy region{from_offset, to_offset, bytes};
    context_.vk().vkCmdCopyBuffer(handle(), from.handle(), to.handle(), 1, &region);
}

void Commands::fill(const Buffer& target, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
    if (bytes == 0) return;
    check_range(target, offset, bytes, "fill");
    context_.vk().vkCmdFillBuffer(handle(), target.handle(), offset, bytes, word);
}

std::vector<std::byte> download_bytes(Context& context, const Buffer& buffer, std::uint64_t offset,
                                      std::uint64_t bytes) {
    if (bytes == 0) return {};
    check_range(buffer, offset, bytes, "download");
    Buffer readback(context, {.name = "readback of " + buffer.name(), .bytes = bytes, .memory = Memory::readback});
    Commands commands(context, "download");
    {
        const auto pass = commands.pass("download");
        commands.copy(buffer, offset, readback, 0, bytes);
    }
    context.wait(commands.submit());
    return {readback.mapped(), readback.mapped() + bytes};
}

}  // namespace twinray
