// SPDX-License-Identifier: MIT
// `twinray kernels`: what a driver's compiler makes of every kernel, for GPUs that need not be there.
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "cli/kernels/builds.h"
#include "cli/kernels/family.h"
#include "cli/kernels/kernel_list.h"
#include "cli/kernels/limits.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace twinray::cli {
namespace {

struct KernelsOptions {
    std::string device, filter;
    std::vector<std::string> families;
    std::filesystem::path against, json;
};

bool fits(const ListedKernel& kernel, const std::string& filter) {
    return (kernel.name + ' ' + kernel.variant).find(filter) != std::string::npos;
}

// In the order of the list. Each pipeline goes before its thread compiles the next one.
std::vector<KernelRow> compile_all(const KernelList& list, const std::string& device, const std::string& filter) {
    std::vector<KernelRow> rows(list.kernels.size());
    parallel_for(rows.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ListedKernel& kernel = list.kernels[i];
            if (!fits(kernel, filter)) continue;
            const KernelStatistics statistics = compile_for_statistics(*list.context, kernel.desc, kernel.args_bytes);
            rows[i] = {device, kernel.name, kernel.variant, figures_of(statistics.told), statistics.subgroup_size};
        }
    });
    std::erase_if(rows, [](const KernelRow& row) { return row.kernel.empty(); });
    return rows;
}

void report_builds(const KernelsOptions& options, const std::string& device, Context& context) {
    const std::vector<BuildRow> builds = list_builds(context);
    std::cout << "SwTlas, one mesh of " << build_triangles << " triangles and one instance:\n\n"
              << table_of(builds) << std::endl;
    for (const BuildRow& row : builds) append_json(options.json, to_json(row, device));
}

// Of the device, or of the family where it is not empty.
std::vector<KernelRow> report(const KernelsOptions& options, const std::string& family) {
    if (!family.empty()) pretend_family(family);
    CommonOptions common;
    common.device = options.device;
    common.pipelines = "";
    const ContextDesc desc = context_desc(common);
    const KernelList list = list_kernels(desc);
    const DeviceFacts& facts = list.context->facts();
    const std::string device = family.empty() ? facts.name : family;
    std::vector<KernelRow> rows = compile_all(list, device, options.filter);
    std::cout << device << ": " << facts.name << ", " << facts.driver << "\n\n" << table_of(rows) << std::endl;
    append_json(options.json, {{"device", device}, {"name", facts.name}, {"driver", facts.driver}});
    for (const KernelRow& row : rows) append_json(options.json, to_json(row));
    if (options.filter.empty()) report_builds(options, device, *list.context);
    return rows;
}

int check(const std::vector<KernelRow>& rows, const std::filesystem::path& against) {
    if (against.empty()) return 0;
    const std::vector<std::string> faults = grown(rows, read_rows(against));
    for (const std::string& fault : faults) std::cout << fault << '\n';
    std::cout << rows.size() << " kernels, " << faults.size() << " past the limits of " << against.string() << '\n';
    return faults.empty() ? 0 : 1;
}

int run(const KernelsOptions& options) {
    std::vector<KernelRow> rows;
    if (options.families.empty()) rows = report(options, "");
    for (const std::string& family : options.families) {
        const std::vector<KernelRow> of_family = report(options, family);
        rows.insert(rows.end(), of_family.begin(), of_family.end());
    }
    if (rows.empty()) fail("no kernel has '", options.filter, "' in its name or specialisation");
    return check(rows, options.against);
}

}  // namespace

Command kernels_command() {
    const auto options = std::make_shared<KernelsOptions>();
    return {
        .name = "kernels",
        .group = "Checking",
        .summary = "what a driver's compiler makes of every kernel: registers, scratch, instructions",
        .description =
            "Compiles every kernel that a program can get from the library, and those of the path tracer, and prints "
            "what the driver tells of each (VK_KHR_pipeline_executable_properties): VGPR, registers of a lane; waves, "
            "how many subgroups a unit keeps at a time; scratch, bytes of memory that stand in for registers, of a "
            "subgroup; shared, bytes of a group; instructions. What it does not tell is empty. Then what builds of the "
            "software accelerator record, and the bytes a triangle that they move at least. Nothing runs: with "
            "--family, Mesa's driver RADV compiles for GPUs of AMD that are not there.",
        .sections = {{"Which",
                      {{.name = "--device",
                        .value = word(options->device, "DEVICE"),
                        .help = "index or a part of the name, as `twinray devices` shows them; the fastest if not "
                                "given",
                        .excludes = {"--family"}},
                       {.name = "--family",
                        .value = words(options->families, "FAMILY,..."),
                        .help = "GPUs of AMD, by the names that RADV has for them: navi10 (RDNA 1), navi21 (RDNA 2), "
                                "navi31 (RDNA 3), gfx1201 (RDNA 4), ..."},
                       {.name = "--filter",
                        .value = word(options->filter, "TEXT"),
                        .help = "only kernels with this in their name or specialisation"}}},
                     {"Output",
                      {{.name = "--against",
                        .value = file(options->against),
                        .help = "what --json wrote earlier: says which kernels take more registers, scratch or shared "
                                "memory, or 2 % more instructions, and which are new"},
                       json_option(options->json)}}},
        .examples = {{"twinray kernels --family navi21,navi31,gfx1201", "three generations, without any of them"},
                     {"twinray kernels --filter \"swtlas_trace closest\"", "what traces on this device"}},
        .fault = "a kernel grew past its limit, or has none",
        .run = [options] { return run(*options); }};
}

}  // namespace twinray::cli
