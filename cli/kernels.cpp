// SPDX-License-Identifier: MIT
// `twinray kernels`: what a driver's compiler makes of every kernel, for GPUs that need not be there.
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/command/values.h"
#include "cli/commands.h"
#include "cli/common.h"
#include "engine/core/error.h"
#include "validation/kernels/compile.h"

namespace twinray::cli {
namespace {

struct KernelsOptions {
    std::string device, filter;
    std::vector<std::string> families;
    std::filesystem::path against, json;
};

void report(const KernelsOptions& options, const kernels::CompiledKernels& of) {
    std::cout << of.device << ": " << of.name << ", " << of.driver << "\n\n"
              << table_of(std::span(of.rows)) << std::endl;
    append_json(options.json, {{"device", of.device}, {"name", of.name}, {"driver", of.driver}});
    for (const kernels::KernelRow& row : of.rows) append_json(options.json, to_json(row));
    if (of.builds.empty()) return;
    std::cout << "SwTlas, one mesh of " << kernels::build_triangles << " triangles and one instance:\n\n"
              << table_of(std::span(of.builds)) << std::endl;
    for (const kernels::BuildRow& row : of.builds) append_json(options.json, to_json(row, of.device));
}

int check(const std::vector<kernels::KernelRow>& rows, const std::filesystem::path& against) {
    if (against.empty()) return 0;
    const std::vector<std::string> faults = grown(rows, kernels::read_rows(against));
    for (const std::string& fault : faults) std::cout << fault << '\n';
    std::cout << rows.size() << " kernels, " << faults.size() << " past the limits of " << against.string() << '\n';
    return faults.empty() ? 0 : 1;
}

int run(const KernelsOptions& options) {
    CommonOptions common;
    common.device = options.device;
    common.pipelines = "";
    std::vector<kernels::KernelRow> rows;
    for (const std::string& family : options.families.empty() ? std::vector<std::string>{""} : options.families) {
        const kernels::CompiledKernels compiled =
            kernels::compile_kernels(context_desc(common), family, options.filter);
        report(options, compiled);
        rows.insert(rows.end(), compiled.rows.begin(), compiled.rows.end());
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
