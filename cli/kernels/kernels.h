// The parts of `twinray kernels`: the list of kernels that hosts get, figures of a driver's compiler, limits of those,
// and GPUs that are not there.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/context.h"
#include "engine/core/kernel.h"

namespace twinray::kernels {

// The statistics that a driver gives of a kernel that it has compiled -------------------------------------------------

struct Statistic {
    std::string name;  // in the driver's words
    std::variant<bool, std::int64_t, std::uint64_t, double> value;
};

struct KernelStatistics {
    std::vector<Statistic> told;      // empty if the driver gives none
    std::uint32_t subgroup_size = 0;  // 0: not told
};

// Compiles the kernel and frees it. Needs a context with ContextDesc::watch_kernels. Throws Error naming the kernel if
// it cannot be compiled.
KernelStatistics compile_for_statistics(Context& context, const KernelDesc& desc, std::uint32_t args_bytes);

// Drivers report these under names of their own; empty if this driver does not.
struct KernelFigures {
    std::optional<std::uint64_t> vgprs;          // registers of a lane; Turnip's are of four words
    std::optional<std::uint64_t> sgprs;          // registers of a subgroup
    std::optional<std::uint64_t> waves;          // subgroups that a unit keeps at a time, at most
    std::optional<std::uint64_t> scratch_bytes;  // memory that stands in for registers: of a subgroup with Mesa's RADV
    std::optional<std::uint64_t> shared_bytes;   // of a group
    std::optional<std::uint64_t> instructions;
    std::optional<std::uint64_t> code_bytes;
    std::optional<std::uint64_t> spills;  // how often a register is kept elsewhere: in memory or in one of another kind

    bool operator==(const KernelFigures&) const = default;
};
using KernelFigure = std::optional<std::uint64_t> KernelFigures::*;
// Knows the names of Mesa's drivers and of NVIDIA's, in any case. If one figure has several names, their values add up.
// A value below 0 is none.
KernelFigures figures_of(std::span<const Statistic> told);

// The resources that kernels take, as rows of a table or a file, and compared with an earlier file --------------------

struct KernelRow {
    std::string device;  // or its family
    std::string driver;  // the one that compiled it, with its version; empty: not told
    std::string kernel, variant;
    KernelFigures figures;
    std::uint32_t subgroup_size = 0;  // 0: not told
};

nlohmann::json to_json(const KernelRow& row);
// Reads rows that `twinray kernels --json` wrote; of other lines, it reads only the driver of each device. Throws Error
// naming the file and the line.
std::vector<KernelRow> read_rows(const std::filesystem::path& file);

// Returns Mesa's release, "26.2" of "NVK Mesa 26.2.6-1": the next compiles otherwise. Empty for drivers not of Mesa.
std::string mesa_release_of(const std::string& driver);
// Returns a sentence for each device of `rows` whose limits come from another release of Mesa.
std::vector<std::string> not_comparable(std::span<const KernelRow> rows, std::span<const KernelRow> limits);

// Returns a sentence for each figure that grew past that of the row of the same name in `limits`, and for each row that
// `limits` lacks. Registers, scratch, shared memory and spills may not grow at all, instructions by `margin`. Passes
// over what is not_comparable().
inline constexpr double instruction_margin = 0.02;
std::vector<std::string> grown(std::span<const KernelRow> rows, std::span<const KernelRow> limits,
                               double margin = instruction_margin);

// Returns columns kernel, specialisation, VGPR, waves, scratch, shared, spills, instructions; empty if not told.
std::string table_of(std::span<const KernelRow> rows);

// The kernels that hosts get, as the engine itself makes them ---------------------------------------------------------

// A module with its specialisation constants. No two have the same name and variant.
struct ListedKernel {
    std::string name, variant;
    KernelDesc desc;
    std::uint32_t args_bytes = 0;
};

// All kernels, each once, in the order in which they were made: those of both accelerators where the device has them,
// for every layout, level and query, of everything else in the library, and of the path tracer. `desc` is made into a
// context that runs nothing.
struct KernelList {
    std::unique_ptr<Context> context;
    std::vector<ListedKernel> kernels;
};
KernelList list_kernels(const ContextDesc& desc);

// Describes the constants in words: "compressed4 watertight instances". Omits how many invocations make a group, so
// that a kernel keeps its name when that changes.
std::string variant_of(const KernelDesc& desc);

// Rows of `twinray kernels`, in compile.cpp: kernels as the compiler of a device makes them, and what builds of SwTlas
// record and move.

struct BuildRow {
    std::string what;  // "build", "refit"
    std::string layout, quality;
    std::uint64_t dispatches = 0, barriers = 0, copies = 0;
    double read = 0, written = 0;  // bytes per triangle, to compare a time on a device with
};

// Builds one mesh of build_triangles and one instance, by the software accelerator, in each layout and quality. The
// context runs nothing (ContextDesc::watch_kernels).
inline constexpr std::size_t build_triangles = 81'920;
std::vector<BuildRow> list_builds(Context& context);

std::string table_of(std::span<const BuildRow> rows);
nlohmann::json to_json(const BuildRow& row, const std::string& device);

// The kernels of list_kernels(), as the compiler of one device makes them.
struct CompiledKernels {
    std::string device;  // or its family
    std::string name, driver;
    std::vector<KernelRow> rows;   // in the order of the list
    std::vector<BuildRow> builds;  // none with a filter
};

// Compiles for the device of `desc`, or, if `family` is not empty, for that family, which is in effect (see below).
// `filter`: only kernels with this in their name or variant; "": all.
CompiledKernels compile_kernels(ContextDesc desc, const std::string& family, const std::string& filter);

// GPUs that are not there: Mesa's drivers compile for them over a shim, a library that answers for the kernel's side --

struct Family {
    const char* name;      // as users write it
    const char* what;      // "NVIDIA Ampere"
    const char* driver;    // "NVK"
    const char* manifest;  // begins the name of the file by which the Vulkan loader finds the driver
    const char* shim;      // of Debian's package mesa-drm-shim
    const char* variable;  // set to `value`, tells the shim the GPU
    const char* value;
    const char* says;  // part of the device's name
};

std::span<const Family> all_families();
// Throws Error naming all families if there is none of this name.
const Family& find_family(const std::string& name);

// Returns whether this process runs over the family's shim.
bool is_in_effect(const Family& family);

// Runs this program once more, over the family's shim and with its driver alone, and returns its exit status. Throws
// Error where the driver or the shim is not installed, and where the driver ends the process.
int run_again(const Family& family, const std::vector<std::string>& arguments);

// Returns the family's device, as ContextDesc::device. Throws Error if shim or driver know no such GPU. Call it only if
// is_in_effect().
std::string find_device(const Family& family);

}  // namespace twinray::kernels
