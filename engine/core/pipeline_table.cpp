// SPDX-License-Identifier: MIT
#include "engine/core/pipeline_table.h"

#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/kernel_addresses.h"
#include "engine/core/vulkan.h"

namespace twinray {
namespace {

// The constants of twinray/glsl/common.glsl.
constexpr std::uint32_t fused_fma_constant = 105, compares_numbers_constant = 106;

std::string key_of(const KernelDesc& desc, std::uint32_t args_bytes) {
    std::string key;
    const auto add = [&](const void* data, std::size_t bytes) { key.append(static_cast<const char*>(data), bytes); };
    add(&args_bytes, sizeof(args_bytes));
    add(&desc.has_images, sizeof(desc.has_images));
    const std::size_t constants = desc.constants.size();
    add(&constants, sizeof(constants));
    add(desc.constants.data(), constants * sizeof(SpecializationConstant));
    add(desc.spirv.data(), desc.spirv.size_bytes());
    return key;
}

std::vector<SpecializationConstant> constants_of(const Context& context, const KernelDesc& desc) {
    std::vector<SpecializationConstant> constants = desc.constants;
    constants.push_back({fused_fma_constant, context.state().tuning().has_fused_fma});
    constants.push_back({compares_numbers_constant, context.state().tuning().compares_numbers});
    return constants;
}

VkPipeline new_pipeline(Context& context, const KernelDesc& desc, VkPipelineLayout layout, Telling telling) {
    const VkShaderModule module = create_shader_module(context, desc.spirv, constants_of(context, desc), desc.name);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    if (telling == Telling::statistics) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkPipelineCache cache = telling == Telling::statistics ? VK_NULL_HANDLE : context.state().pipeline_cache();
    const VkResult result =
        context.state().vk().vkCreateComputePipelines(context.device(), cache, 1, &info, nullptr, &pipeline);
    context.state().vk().vkDestroyShaderModule(context.device(), module, nullptr);
    if (result != VK_SUCCESS) fail("kernel '", desc.name, "': create the pipeline: ", name_of(result));
    context.state().set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), desc.name);
    return pipeline;
}

}  // namespace

CompiledKernel::~CompiledKernel() {
    vk.vkDestroyPipeline(device, pipeline, nullptr);
    vk.vkDestroyPipelineLayout(device, layout, nullptr);
}

std::shared_ptr<CompiledKernel> compile(Context& context, const KernelDesc& desc, std::uint32_t args_bytes,
                                        Telling telling) {
    auto kernel = std::make_shared<CompiledKernel>(context.state().vk(), context.device());
    kernel->layout =
        create_push_constant_layout(context, VK_SHADER_STAGE_COMPUTE_BIT, args_bytes,
                                    desc.has_images ? context.state().image_array_layout() : VK_NULL_HANDLE);
    kernel->pipeline = new_pipeline(context, desc, kernel->layout, telling);
    kernel->addresses = kernel_addresses(desc.spirv);
    return kernel;
}

// Compiles unlocked: if two threads compile the same, the first result is used.
std::shared_ptr<CompiledKernel> PipelineTable::get(Context& context, const KernelDesc& desc, std::uint32_t args_bytes) {
    context.state().check_process();
    std::string key = key_of(desc, args_bytes);
    if (std::shared_ptr<CompiledKernel> kernel = find(key)) return kernel;
    std::shared_ptr<CompiledKernel> kernel = compile(context, desc, args_bytes, Telling::nothing);
    const std::lock_guard lock(mutex_);
    return entries_.try_emplace(std::move(key), Entry{std::move(kernel)}).first->second.kernel;
}

std::shared_ptr<CompiledKernel> PipelineTable::find(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : found->second.kernel;
}

void PipelineTable::give_back(Context& context, std::shared_ptr<CompiledKernel> kernel) {
    if (!context.state().is_of_this_process()) return;
    std::shared_ptr<CompiledKernel> gone;
    {
        const std::lock_guard lock(mutex_);
        for (auto& [key, entry] : entries_)
            if (entry.kernel == kernel) entry.given_back = ++given_back_;
        kernel.reset();
        gone = take_oldest_unused();
    }
    if (gone) context.state().retire([gone] {});
}

// Returns null while there are not too many.
std::shared_ptr<CompiledKernel> PipelineTable::take_oldest_unused() {
    std::size_t unused = 0;
    auto oldest = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (entry->second.kernel.use_count() > 1) continue;
        ++unused;
        if (oldest == entries_.end() || entry->second.given_back < oldest->second.given_back) oldest = entry;
    }
    if (unused <= most_unused) return nullptr;
    return std::move(entries_.extract(oldest).mapped().kernel);
}

std::size_t PipelineTable::size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

void PipelineTable::clear() {
    const std::lock_guard lock(mutex_);
    entries_.clear();
}

}  // namespace twinray
