#include "cli/kernels/kernels.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/vulkan.h"

namespace twinray::kernels {
namespace {

struct Word {
    std::string_view name;  // in lower case
    KernelFigure figure;
};

constexpr std::string_view registers_of_turnip = "registers used";  // each is four words per lane

constexpr Word words[] = {
    // RADV
    {"vgprs", &KernelFigures::vgprs},
    {"sgprs", &KernelFigures::sgprs},
    {"subgroups per simd", &KernelFigures::waves},
    {"scratch size", &KernelFigures::scratch_bytes},
    {"lds size", &KernelFigures::shared_bytes},
    {"instructions", &KernelFigures::instructions},
    {"code size", &KernelFigures::code_bytes},
    {"spilled vgprs", &KernelFigures::spills},
    {"spilled sgprs", &KernelFigures::spills},
    // NVK, which has its count of instructions and its size of code as others have
    {"number of gprs", &KernelFigures::vgprs},
    {"max warps/sm", &KernelFigures::waves},
    {"slm size", &KernelFigures::scratch_bytes},
    {"spills to reg", &KernelFigures::spills},
    {"spills to memory", &KernelFigures::spills},
    // Turnip, likewise
    {registers_of_turnip, &KernelFigures::vgprs},
    {"max waves per core", &KernelFigures::waves},
    {"stp count", &KernelFigures::spills},
    // ANV
    {"instruction count", &KernelFigures::instructions},
    {"scratch memory size", &KernelFigures::scratch_bytes},
    {"spill count", &KernelFigures::spills},
    {"workgroup memory size", &KernelFigures::shared_bytes},
    // NVIDIA
    {"register count", &KernelFigures::vgprs},
    {"local memory size", &KernelFigures::scratch_bytes},
    {"shared memory size", &KernelFigures::shared_bytes},
    {"binary size", &KernelFigures::code_bytes},
};

std::string lower(std::string_view name) {
    std::string text(name);
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::optional<std::uint64_t> count_of(const Statistic& statistic) {
    return std::visit(
        [](auto value) -> std::optional<std::uint64_t> {
            const auto number = static_cast<double>(value);
            return number >= 0 ? std::optional(static_cast<std::uint64_t>(value)) : std::nullopt;
        },
        statistic.value);
}

Statistic statistic_of(const VkPipelineExecutableStatisticKHR& told) {
    switch (told.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR: return {told.name, told.value.b32 != VK_FALSE};
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return {told.name, std::int64_t{told.value.i64}};
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR: return {told.name, told.value.f64};
        default: return {told.name, std::uint64_t{told.value.u64}};
    }
}

std::uint32_t told_subgroup_size(const Context& context, VkPipeline pipeline) {
    VkPipelineInfoKHR which{};
    which.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    which.pipeline = pipeline;
    VkPipelineExecutablePropertiesKHR properties{};
    properties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::uint32_t count = 1;  // a compute pipeline is one executable
    context.state().vk().vkGetPipelineExecutablePropertiesKHR(context.device(), &which, &count, &properties);
    return count ? properties.subgroupSize : 0;
}

std::vector<Statistic> told_statistics(const Context& context, VkPipeline pipeline) {
    VkPipelineExecutableInfoKHR which{};
    which.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
    which.pipeline = pipeline;
    const auto ask = [&](std::uint32_t& count, VkPipelineExecutableStatisticKHR* rows) {
        vk_check(context.state().vk().vkGetPipelineExecutableStatisticsKHR(context.device(), &which, &count, rows),
                 "read the statistics of a pipeline");
    };
    std::uint32_t count = 0;
    ask(count, nullptr);
    VkPipelineExecutableStatisticKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> rows(count, empty);
    ask(count, rows.data());
    std::vector<Statistic> told;
    for (const VkPipelineExecutableStatisticKHR& row : std::span(rows).first(count)) told.push_back(statistic_of(row));
    return told;
}

}  // namespace

KernelStatistics compile_for_statistics(Context& context, const KernelDesc& desc, std::uint32_t args_bytes) {
    if (!context.state().watch())
        fail("kernel '", desc.name, "': statistics need a context with ContextDesc::watch_kernels");
    const bool can_tell = context.state().vk().vkGetPipelineExecutableStatisticsKHR != nullptr;
    const auto kernel = compile(context, desc, args_bytes, can_tell ? Telling::statistics : Telling::nothing);
    if (!can_tell) return {};
    return {told_statistics(context, kernel->pipeline), told_subgroup_size(context, kernel->pipeline)};
}

KernelFigures figures_of(std::span<const Statistic> told) {
    KernelFigures figures;
    bool counts_words = false;  // code is counted in words, not bytes
    for (const Statistic& statistic : told) {
        const std::string name = lower(statistic.name);
        for (const Word& word : words) {
            const std::optional<std::uint64_t> count = count_of(statistic);
            if (name != word.name || !count) continue;
            figures.*word.figure = (figures.*word.figure).value_or(0) + *count;
        }
        counts_words |= name == registers_of_turnip;
    }
    if (counts_words && figures.code_bytes) *figures.code_bytes *= 4;
    return figures;
}

}  // namespace twinray::kernels
