#include "engine/core/kernel.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/spirv_words.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// vkCmdDispatch guarantees 65535 groups per dimension; larger counts spread over y (global_index() undoes it).
constexpr std::uint64_t groups_per_row = 32768;

using spirv::Op, spirv::Words;
using spirv::op_of, spirv::words_of;

struct Member {
    std::string name;
    std::uint32_t type = 0, offset = 0;
};

// The declarations of a module, which precede its functions.
class Declarations {
  public:
    explicit Declarations(Words module) {
        for (std::size_t at = spirv::header_words, words = 0; at < module.size(); at += words) {
            words = words_of(module[at]);
            if (op_of(module[at]) == Op::Function || words == 0 || words > module.size() - at) return;
            take(module.subspan(at, words));
        }
    }
    std::vector<KernelAddress> addresses() const {
        std::vector<KernelAddress> found;
        if (pushed_ != 0) collect(pushed_, "", 0, found);
        return found;
    }

  private:
    void take(Words words) {
        using enum Op;
        switch (op_of(words[0])) {
            case MemberName:
                structs_[words[1]][words[2]].name = reinterpret_cast<const char*>(words.data() + 3);
                return;
            case MemberDecorate:
                if (words[3] == spirv::decoration_offset) structs_[words[1]][words[2]].offset = words[4];
                return;
            case TypeStruct:
                for (std::uint32_t i = 2; i < words.size(); ++i) structs_[words[1]][i - 2].type = words[i];
                return;
            case TypePointer: pointees_[words[1]] = words[3]; return;
            case Variable:
                if (words[3] == spirv::storage_push_constant) pushed_ = pointees_[words[1]];
                return;
            default: return;
        }
    }

    // Such structs are declared by REFERENCE of twinray/glsl/common.glsl.
    static bool is_ref(const std::map<std::uint32_t, Member>& members) {
        return members.size() == 1 && members.begin()->second.name == "address";
    }
    void collect(std::uint32_t type, const std::string& name, std::uint32_t offset,
                 std::vector<KernelAddress>& found) const {
        const auto members = structs_.find(type);
        if (members == structs_.end()) return;
        if (is_ref(members->second)) return found.push_back({name, offset});
        for (const auto& [index, member] : members->second)
            collect(member.type, name.empty() ? member.name : name + "." + member.name, offset + member.offset, found);
    }

    std::map<std::uint32_t, std::map<std::uint32_t, Member>> structs_;  // by id, by index
    std::map<std::uint32_t, std::uint32_t> pointees_;
    std::uint32_t pushed_ = 0;
};

}  // namespace

VkShaderModule create_shader_module(Context& context, std::span<const std::uint32_t> spirv,
                                    std::span<const SpecializationConstant> constants, const std::string& name) {
    if (!spirv::is_module(spirv)) fail("shader '", name, "': its ", spirv.size(), " words are not a SPIR-V module");
    const std::vector<std::uint32_t> needed = prune_branches(freeze_constants(spirv, constants));
    VkShaderModuleCreateInfo info = OfType{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = 4 * needed.size();
    info.pCode = needed.data();
    VkShaderModule module = VK_NULL_HANDLE;
    const VkResult result = context.state().vk().vkCreateShaderModule(context.device(), &info, nullptr, &module);
    if (result != VK_SUCCESS) fail("shader '", name, "': ", name_of(result));
    context.state().set_name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<std::uint64_t>(module), name);
    return module;
}

VkPipelineLayout create_push_constant_layout(Context& context, VkShaderStageFlags stages, std::uint32_t bytes,
                                             VkDescriptorSetLayout images) {
    const VkPushConstantRange range{stages, 0, bytes};
    VkPipelineLayoutCreateInfo info = OfType{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = images ? 1 : 0;
    info.pSetLayouts = &images;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    return created(context.state().vk().vkCreatePipelineLayout, context.device(), info, "create a pipeline layout");
}

ComputePipeline::ComputePipeline(Context& context, const KernelDesc& desc, std::uint32_t args_bytes)
    : context_(context), desc_(desc), args_bytes_(args_bytes) {
    if (context.state().watch()) context.state().watch()(desc, args_bytes);
    if (context.state().watch() || desc.compiles_when_used) return;
    compiled_ = context.state().pipelines().get(context, desc, args_bytes);
    desc_.spirv = {};
}

ComputePipeline::~ComputePipeline() {
    if (compiled_) context_.state().pipelines().give_back(context_, std::move(compiled_));
}

void ComputePipeline::bind(Commands& commands, const void* args, VkDescriptorSet images) const {
    if (desc_.has_images != (images != VK_NULL_HANDLE))
        fail("kernel '", desc_.name, "': ", desc_.has_images ? "dispatched without images" : "it takes no images");
    if (!compiled_) compiled_ = context_.state().pipelines().get(context_, desc_, args_bytes_);
    const VulkanTable& vk = context_.state().vk();
    vk.vkCmdBindPipeline(commands.handle(), VK_PIPELINE_BIND_POINT_COMPUTE, compiled_->pipeline);
    if (images)
        vk.vkCmdBindDescriptorSets(commands.handle(), VK_PIPELINE_BIND_POINT_COMPUTE, compiled_->layout, 0, 1, &images,
                                   0, nullptr);
    const std::vector<std::byte> readable =
        readable_args(context_, desc_.name, compiled_->addresses, {static_cast<const std::byte*>(args), args_bytes_});
    vk.vkCmdPushConstants(commands.handle(), compiled_->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, args_bytes_,
                          readable.data());
}

void ComputePipeline::dispatch_groups(Commands& commands, const void* args, std::uint64_t group_count,
                                      VkDescriptorSet images) const {
    if (group_count == 0) return;
    std::optional<Commands::Pass> own_pass;
    if (!commands.in_pass()) own_pass.emplace(commands, desc_.name);
    if (!context_.state().watch()) bind(commands, args, images);
    commands.count_groups(group_count);
    const std::uint64_t rows = (group_count + groups_per_row - 1) / groups_per_row;
    context_.state().vk().vkCmdDispatch(commands.handle(),
                                        static_cast<std::uint32_t>(std::min(group_count, groups_per_row)),
                                        static_cast<std::uint32_t>(rows), 1);
}

void ComputePipeline::dispatch_indirect(Commands& commands, const void* args, const Buffer& counts,
                                        std::uint64_t offset) const {
    std::optional<Commands::Pass> own_pass;
    if (!commands.in_pass()) own_pass.emplace(commands, desc_.name);
    if (!context_.state().watch()) bind(commands, args, VK_NULL_HANDLE);
    context_.state().vk().vkCmdDispatchIndirect(commands.handle(), counts.handle(), offset);
}

std::vector<KernelAddress> kernel_addresses(std::span<const std::uint32_t> spirv) {
    return Declarations(spirv).addresses();
}

std::vector<std::byte> readable_args(Context& context, const std::string& kernel,
                                     std::span<const KernelAddress> addresses, std::span<const std::byte> args) {
    std::vector<std::byte> readable(args.begin(), args.end());
    const std::uint64_t absent = context.absent();
    const bool is_checked = context.state().is_validating() && context.properties().kind == DeviceKind::cpu;
    for (const KernelAddress& member : addresses) {
        if (member.offset + sizeof(std::uint64_t) > readable.size())
            fail("kernel '", kernel, "': its arguments have ", readable.size(), " bytes, and the module reads '",
                 member.name, "' at ", member.offset);
        std::byte* const at = readable.data() + member.offset;
        std::uint64_t address = 0;
        std::memcpy(&address, at, sizeof(address));
        if (address == 0) address = absent;
        std::memcpy(at, &address, sizeof(address));
        if (is_checked && !platform::is_mapped(address))
            context.state().add_validation_message(
                text("kernel '", kernel, "': nothing can be read at '", member.name, "', address ", address));
    }
    return readable;
}

}  // namespace twinray
