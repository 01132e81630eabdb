// SPDX-License-Identifier: MIT
#include "cli/kernels/compile.h"

#include "engine/core/parallel.h"
#include "cli/kernels/family.h"
#include "cli/kernels/kernel_list.h"

namespace twinray::kernels {
namespace {

bool fits(const ListedKernel& kernel, const std::string& filter) {
    return (kernel.name + ' ' + kernel.variant).find(filter) != std::string::npos;
}

// Each pipeline goes before its thread compiles the next one.
std::vector<KernelRow> compile_all(const KernelList& list, const std::string& device, const std::string& filter) {
    std::vector<KernelRow> rows(list.kernels.size());
    parallel_for(rows.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ListedKernel& kernel = list.kernels[i];
            if (!fits(kernel, filter)) continue;
            const KernelStatistics statistics = compile_for_statistics(*list.context, kernel.desc, kernel.args_bytes);
            rows[i] = {device,         list.context->properties().driver, kernel.name,
                       kernel.variant, figures_of(statistics.told),       statistics.subgroup_size};
        }
    });
    std::erase_if(rows, [](const KernelRow& row) { return row.kernel.empty(); });
    return rows;
}

}  // namespace

CompiledKernels compile_kernels(ContextDesc desc, const std::string& family, const std::string& filter) {
    if (!family.empty()) desc.device = find_device(find_family(family));
    const KernelList list = list_kernels(desc);
    const DeviceProperties& properties = list.context->properties();
    const std::string device = family.empty() ? properties.name : family;
    return {device, properties.name, properties.driver, compile_all(list, device, filter),
            filter.empty() ? list_builds(*list.context) : std::vector<BuildRow>()};
}

}  // namespace twinray::kernels
