// `twinray kernels`: what a driver's compiler makes of every kernel, for GPUs that need not be there.
#include "cli/common.h"
#include "cli/kernels/kernels.h"

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
    const std::vector<kernels::KernelRow> limits = kernels::read_rows(against);
    const std::vector<std::string> others = not_comparable(rows, limits), faults = grown(rows, limits);
    for (const std::string& fault : others) std::cout << fault << '\n';
    for (const std::string& fault : faults) std::cout << fault << '\n';
    std::cout << rows.size() << " kernels, " << faults.size() << " past the limits of " << against.string() << '\n';
    return others.empty() && faults.empty() ? 0 : 1;
}

int compile(const KernelsOptions& options, const std::string& family) {
    CommonOptions common;
    common.device = options.device;
    common.pipelines = "";
    const kernels::CompiledKernels compiled = kernels::compile_kernels(context_desc(common), family, options.filter);
    report(options, compiled);
    if (compiled.rows.empty()) fail("no kernel has '", options.filter, "' in its name or specialisation");
    return check(compiled.rows, options.against);
}

// Compiles one family after the other, each in its own process: a shim stands in for one GPU from a process's start.
int compile_families(const KernelsOptions& options) {
    int status = 0;
    for (const std::string& family : options.families) try {
            std::vector<std::string> arguments{"kernels", "--family", family, "--filter", options.filter};
            if (!options.against.empty()) arguments.insert(arguments.end(), {"--against", options.against.string()});
            if (!options.json.empty()) arguments.insert(arguments.end(), {"--json", options.json.string()});
            status = std::max(status, kernels::run_again(kernels::find_family(family), arguments));
        } catch (const Error& error) {
            std::cerr << "twinray: " << error.what() << '\n';
            status = 1;
        }
    return status;
}

int run(const KernelsOptions& options) {
    if (options.families.empty()) return compile(options, "");
    if (options.families.size() == 1 && is_in_effect(kernels::find_family(options.families[0])))
        return compile(options, options.families[0]);
    return compile_families(options);
}

// Their names are too many for the line that names the option.
Value families(std::vector<std::string>& target) {
    std::vector<std::string> names;
    for (const kernels::Family& family : kernels::all_families()) names.emplace_back(family.name);
    Value value = choices(target, names);
    value.metavar = "FAMILY,...";
    return value;
}

}  // namespace

Command kernels_command() {
    const auto options = std::make_shared<KernelsOptions>();
    return {
        .name = "kernels",
        .group = "Checking",
        .summary = "print register use, scratch and instruction counts of every kernel, even without the GPU",
        .description =
            "Compiles every kernel that the library or the path tracer can use and prints the driver's statistics "
            "(VK_KHR_pipeline_executable_properties). VGPR: registers per lane. waves: subgroups that a unit holds at "
            "a time. scratch: bytes per subgroup of memory in place of registers. shared: bytes per workgroup. spills: "
            "times that a register is saved elsewhere. instructions: their number. A figure that the driver does not "
            "report is left empty. Then prints what builds of the software accelerator record, and the least number of "
            "bytes per triangle that they move. No kernel runs. With --family, Mesa's drivers compile for GPUs that "
            "this machine does not have, with the shims of Debian's package mesa-drm-shim.",
        .sections = {{"Selection",
                      {{.name = "--device",
                        .value = word(options->device, "DEVICE"),
                        .help = "index of the device or part of its name, as `twinray devices` prints them; without "
                                "it, the fastest device",
                        .excludes = {"--family"}},
                       {.name = "--family",
                        .value = families(options->families),
                        .help =
                            "compile for these GPUs, which this machine need not have: AMD (navi10, navi21, navi31, "
                            "gfx1201: RDNA 1 to 4), NVIDIA (turing, ampere, ada, blackwell) and Qualcomm (adreno740)"},
                       {.name = "--filter",
                        .value = word(options->filter, "TEXT"),
                        .help = "compile only kernels whose name or specialisation contains this text"}}},
                     {"Output",
                      {{.name = "--against",
                        .value = file(options->against),
                        .help = "compare with this output of an earlier --json: list kernels that take more registers, "
                                "scratch, shared memory or spills, or 2 % more instructions, and kernels that are new; "
                                "figures from another release of Mesa cannot be compared and count as a fault"},
                       json_option(options->json)}}},
        .examples = {{"twinray kernels --family navi31,ampere,adreno740",
                      "kernels for three vendors' GPUs, without any of them"},
                     {"twinray kernels --filter \"swtlas_trace closest\"",
                      "kernels that trace closest hits on this device"}},
        .fault = "a kernel exceeds its limit, or no limit can be compared with it",
        .run = [options] { return run(*options); }};
}

}  // namespace twinray::cli
