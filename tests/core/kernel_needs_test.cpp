// Needs of kernels: every SPIR-V module of the build declares no more than the table of requirements says of its parts
// of twinray, so that no device is asked for what a scene does not need.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "engine/core/requirement.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/radix_sort.h"
#include "engine/core/spirv_words.h"

namespace twinray {
namespace {

// The needs of a SPIR-V module from a device, read from its words.
struct SpirvNeeds {
    std::uint32_t version = 0;             // 0x00010500 is 1.5
    std::set<std::uint32_t> capabilities;  // those of subgroup operations among them
    std::set<std::string> extensions;
    std::uint64_t shared_bytes = 0;       // a vec3 as 16 bytes, which a driver may give it
    std::uint64_t group_invocations = 0;  // 0: no compute shader
    std::uint64_t push_constant_bytes = 0;
};

using spirv::Op, spirv::Words;
using spirv::op_of, spirv::words_of;
using Id = std::uint32_t;

constexpr std::uint32_t mode_local_size = 17, workgroup_size = 25;

class Reader {
  public:
    Reader(Words module, const std::map<std::uint32_t, std::uint32_t>& constants) : constants_(constants) {
        if (module.size() < spirv::header_words || module[0] != 0x07230203u) fail("no SPIR-V module");
        needs_.version = module[1];
        for (std::size_t at = spirv::header_words; at < module.size(); at += words_of(module[at]))
            take(module.subspan(at, words_of(module[at])));
        for (const Words& variable : variables_) add(variable);
        if (group_size_) needs_.group_invocations = product(group_size_);
    }
    SpirvNeeds needs() && { return std::move(needs_); }

  private:
    void take(Words words) {
        using enum Op;
        switch (op_of(words[0])) {
            case Capability: needs_.capabilities.insert(words[1]); return;
            case Extension: needs_.extensions.insert(reinterpret_cast<const char*>(&words[1])); return;
            case ExecutionMode:
                if (words[2] == mode_local_size)
                    needs_.group_invocations = std::uint64_t{words[3]} * words[4] * words[5];
                return;
            case Decorate:
                if (words[2] == spirv::decoration_spec_id) spec_ids_[words[1]] = words[3];
                if (words[2] == spirv::decoration_builtin && words[3] == workgroup_size) group_size_ = words[1];
                return;
            case MemberDecorate:
                if (words[3] == spirv::decoration_offset) offsets_[{words[1], words[2]}] = words[4];
                return;
            case TypeBool:
            case TypeInt:
            case TypeFloat:
            case TypeVector:
            case TypeMatrix:
            case TypeArray:
            case TypeStruct:
            case TypePointer: defined_[words[1]] = words; return;
            case Constant:
            case ConstantComposite:
            case SpecConstant:
            case SpecConstantComposite:
            case SpecConstantOp: defined_[words[2]] = words; return;
            case Variable: variables_.push_back(words); return;
            default: return;
        }
    }

    Words definition(Id id) const {
        const auto found = defined_.find(id);
        if (found == defined_.end()) fail("SPIR-V: id ", id, " is neither a type nor a constant that is known here");
        return found->second;
    }

    void add(Words variable) {
        if (variable[3] != spirv::storage_workgroup && variable[3] != spirv::storage_push_constant) return;
        const Id type = definition(variable[1])[3];
        if (variable[3] == spirv::storage_workgroup)
            needs_.shared_bytes += round_up(size_of(type), 16);
        else
            needs_.push_constant_bytes = std::max(needs_.push_constant_bytes, size_of(type));
    }

    static std::uint64_t round_up(std::uint64_t bytes, std::uint64_t to) { return (bytes + to - 1) / to * to; }

    // A struct with offsets is as large as they say; otherwise vectors of three are as large as those of four.
    std::uint64_t size_of(Id type) const {
        using enum Op;
        const Words words = definition(type);
        switch (op_of(words[0])) {
            case TypeBool: return 4;
            case TypeInt:
            case TypeFloat: return words[2] / 8;
            case TypeVector:
            case TypeMatrix: return words[3] * size_of(words[2]);
            case TypeArray: return value_of(words[3]) * stride_of(words[2]);
            case TypePointer: return 8;
            default: return size_of_struct(words);
        }
    }
    std::uint64_t stride_of(Id element) const {
        const std::uint64_t bytes = size_of(element);
        return bytes > 8 ? round_up(bytes, 16) : bytes;
    }
    std::uint64_t size_of_struct(Words words) const {
        std::uint64_t end = 0;
        for (std::uint32_t member = 0; member + 2 < words.size(); ++member) {
            const auto offset = offsets_.find({words[1], member});
            const Id type = words[member + 2];
            end = offset == offsets_.end() ? end + stride_of(type) : std::max(end, offset->second + size_of(type));
        }
        return end;
    }

    std::uint32_t value_of(Id id) const {
        using enum Op;
        const Words words = definition(id);
        switch (op_of(words[0])) {
            case Constant: return words[3];
            case SpecConstant: {
                const auto spec_id = spec_ids_.find(id);
                if (spec_id == spec_ids_.end() || !constants_.contains(spec_id->second)) return words[3];
                return constants_.at(spec_id->second);
            }
            case SpecConstantOp: return computed(words);
            default: fail("SPIR-V: id ", id, " is no number");
        }
    }
    std::uint32_t computed(Words words) const {
        switch (words[3]) {
            case 81: return value_of(definition(words[4])[3 + words[5]]);  // OpCompositeExtract
            case 128: return value_of(words[4]) + value_of(words[5]);
            case 132: return value_of(words[4]) * value_of(words[5]);
            case 134: return value_of(words[4]) / value_of(words[5]);
            case 196: return value_of(words[4]) << value_of(words[5]);
            default: fail("SPIR-V: a size depends on operation ", words[3]);
        }
    }
    std::uint64_t product(Id composite) const {
        const Words words = definition(composite);
        return std::uint64_t{value_of(words[3])} * value_of(words[4]) * value_of(words[5]);
    }

    const std::map<std::uint32_t, std::uint32_t>& constants_;
    SpirvNeeds needs_;
    Id group_size_ = 0;
    std::map<Id, std::uint32_t> spec_ids_;
    std::map<std::pair<Id, std::uint32_t>, std::uint32_t> offsets_;  // by struct and member
    std::map<Id, Words> defined_;                                    // types and constants
    std::vector<Words> variables_;
};

// `constants` are values of specialisation constants by id, instead of those in the module. Throws Error if a size
// depends on something that this cannot compute.
SpirvNeeds needs_of(std::span<const std::uint32_t> spirv, const std::map<std::uint32_t, std::uint32_t>& constants) {
    return Reader(spirv, constants).needs();
}

using Of = Requirement::Of;
using Parts = std::set<Of>;

// The parts of modules whose names begin so, with the folder of the shader or the name of the kernel; the first that
// fits counts.
struct Family {
    const char* begin;
    Parts parts = {};
};
const Family families[] = {
    {"analysis_"},
    {"collide_classify", {Of::contacts}},
    {"collide_world_triangles", {Of::contacts}},
    {"collide_"},
    {"points_", {Of::points}},
    {"engine_refine_gather", {Of::refinement}},
    {"engine_exact_hits", {Of::refinement}},
    {"engine_"},
    {"scene_"},
    {"verify_float_probe64", {Of::refinement}},
    {"verify_"},
    {"swtlas_"},
    {"hwtlas_trace_query", {Of::ray_queries}},
    {"hwtlas_trace_r", {Of::ray_pipelines}},
    {"hwtlas_", {Of::hardware}},
    // Samples, the suite of `twinray report` and its negative controls, one of which runs where there is float64.
    {"path_tracer_"},
    {"iso_surface_"},
    {"particles_"},
    {"suite_"},
    {"reproducer_query", {Of::ray_queries}},
    {"reproducer_trace_r", {Of::ray_pipelines}},
    {"control_contracted", {Of::refinement}},
    {"control_"},
    // The conformance suite's rays through the driver's structures.
    {"conformance_pipeline_", {Of::ray_pipelines}},
    {"conformance_", {Of::ray_queries}},
    {"materials_"},
    // Made by twinray_add_kernel and twinray_add_trace_program.
    {"all_hits_"},
    {"headless_dispatch_"},
    {"feature_costs_program_"},
    {"broken_program_"},
    {"crossings_"},
    {"host_kernel_"},
    {"cube_"},
    {"test_"},
};

// The meaning of a word of the name, whatever its family.
const std::map<std::string, Of> parts_by_word = {{"hw", Of::ray_queries},           {"rahit", Of::ray_pipelines},
                                                 {"rint", Of::ray_pipelines},       {"refined", Of::refinement},
                                                 {"int64", Of::int64_kernels},      {"images", Of::images},
                                                 {"culling", Of::primitive_culling}};

Parts parts_of_words(const std::string& module) {
    Parts parts;
    std::istringstream name(module);
    for (std::string word; std::getline(name, word, '_');)
        if (const auto found = parts_by_word.find(word); found != parts_by_word.end()) parts.insert(found->second);
    return parts;
}

Parts parts_of(const std::string& module) {
    const auto family = std::ranges::find_if(families, [&](const Family& f) { return module.starts_with(f.begin); });
    if (family == std::end(families)) fail("it belongs to no known part of twinray");
    Parts parts = parts_of_words(module);
    parts.insert(family->parts.begin(), family->parts.end());
    return parts;
}

// Tutorials name their kernels as a reader would, so their folder is their family.
Parts parts_of_file(const std::filesystem::path& file) {
    const std::string name = file.stem().string();
    return file.string().find("/samples/tutorials/") == std::string::npos ? parts_of(name) : parts_of_words(name);
}

// Returns the values that the host gives constants for a GPU; for a CPU's driver it asks the device (KernelTuning).
// Groups that have as many invocations as a vector has lanes are at their largest.
std::map<std::uint32_t, std::uint32_t> constants_of(const std::string& module) {
    if (module.starts_with("engine_sort_scan")) return {{GROUP_SIZE_CONSTANT, SCAN_GPU_GROUP}};
    if (module.starts_with("engine_sort"))
        return {{GROUP_SIZE_CONSTANT, SORT_GPU_GROUP}, {DIGIT_BITS_CONSTANT, SORT_GPU_DIGIT_BITS}};
    return {{GROUP_SIZE_CONSTANT, KernelLimits::group_invocations}};
}

// Returns one sentence for each thing that the module needs and its parts may not.
std::vector<std::string> excess_of(const SpirvNeeds& needs, const Parts& parts) {
    std::set<std::uint32_t> capabilities;
    std::set<std::string> extensions;
    for (const Requirement& requirement : requirements_of({})) {
        if (requirement.of != Of::everything && !parts.contains(requirement.of)) continue;
        capabilities.insert(requirement.capabilities.begin(), requirement.capabilities.end());
        extensions.insert(requirement.spirv_extensions.begin(), requirement.spirv_extensions.end());
    }
    std::vector<std::string> excess;
    for (const std::uint32_t capability : needs.capabilities)
        if (!capabilities.contains(capability)) excess.push_back(text("capability ", capability));
    for (const std::string& extension : needs.extensions)
        if (!extensions.contains(extension)) excess.push_back(extension);
    const auto check_limit = [&](std::uint64_t value, std::uint64_t limit, const char* of_what) {
        if (value > limit) excess.push_back(text(value, of_what, "; the limit is ", limit));
    };
    check_limit(needs.shared_bytes, KernelLimits::shared_bytes, " bytes of shared memory");
    check_limit(needs.group_invocations, KernelLimits::group_invocations, " invocations of a group");
    check_limit(needs.push_constant_bytes, KernelLimits::push_constant_bytes, " bytes of push constants");
    if (needs.version > 0x00010500u) excess.push_back("SPIR-V above 1.5, which is that of Vulkan 1.2");
    return excess;
}

std::vector<std::uint32_t> words_of(const std::filesystem::path& file) {
    const Bytes bytes = read_file(file);
    std::vector<std::uint32_t> spirv(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(spirv.data(), bytes.data(), spirv.size() * sizeof(std::uint32_t));
    return spirv;
}

std::vector<std::filesystem::path> all_modules() {
    std::ifstream list(TWINRAY_MODULE_LIST);
    std::vector<std::filesystem::path> modules;
    for (std::string line; std::getline(list, line);) modules.push_back(line);
    return modules;
}

TEST(KernelNeeds, NoModuleNeedsMoreThanItsPartsOfTwinray) {
    const std::vector<std::filesystem::path> modules = all_modules();
    ASSERT_GT(modules.size(), 100u) << TWINRAY_MODULE_LIST;
    SpirvNeeds all;
    for (const std::filesystem::path& file : modules) {
        const std::string name = file.stem().string();
        try {
            const SpirvNeeds needs = needs_of(words_of(file), constants_of(name));
            for (const std::string& excess : excess_of(needs, parts_of_file(file)))
                ADD_FAILURE() << name << ": " << excess;
            all.capabilities.insert(needs.capabilities.begin(), needs.capabilities.end());
            all.shared_bytes = std::max(all.shared_bytes, needs.shared_bytes);
            all.group_invocations = std::max(all.group_invocations, needs.group_invocations);
            all.push_constant_bytes = std::max(all.push_constant_bytes, needs.push_constant_bytes);
        } catch (const Error& error) {
            ADD_FAILURE() << name << ": " << error.what();
        }
    }
    EXPECT_TRUE(all.shared_bytes && all.group_invocations && all.push_constant_bytes) << "not read";
    EXPECT_TRUE(all.capabilities.contains(10) && all.capabilities.contains(4472)) << "Float64 and RayQueryKHR";
}

TEST(KernelNeeds, AModuleOfNoKnownPartFails) {
    EXPECT_THROW(parts_of("volume_march"), Error);
    EXPECT_EQ(parts_of("hwtlas_trace_query_refined"), (Parts{Of::ray_queries, Of::refinement}));
    EXPECT_EQ(parts_of("all_hits_sw"), Parts{});
    EXPECT_EQ(parts_of("test_program_rint"), Parts{Of::ray_pipelines});
    EXPECT_EQ(parts_of_file("build/samples/tutorials/spirv/picture_hw.spv"), Parts{Of::ray_queries});
    EXPECT_THROW(parts_of_file("build/samples/volume/spirv/march.spv"), Error);
}

// The rows of the table agree: no row has what no kernel uses, and only the rows of float64 and rays have these.
TEST(KernelNeeds, OfThePartsDiffer) {
    constexpr std::uint32_t float64 = 10, int64 = 11, subgroups = 61, ray_query = 4472;
    const auto excess = [](std::uint32_t capability, const Parts& parts) {
        SpirvNeeds needs;
        needs.capabilities = {capability};
        return excess_of(needs, parts);
    };
    const Parts all = {Of::hardware, Of::ray_queries, Of::ray_pipelines, Of::refinement,
                       Of::points,   Of::contacts,    Of::images};
    EXPECT_EQ(excess(int64, all), std::vector<std::string>{"capability 11"});
    EXPECT_EQ(excess(subgroups, all).size(), 1u);
    EXPECT_EQ(excess(float64, {}).size(), 1u);
    EXPECT_EQ(excess(float64, {Of::points}).size(), 0u);
    EXPECT_EQ(excess(ray_query, {Of::hardware}).size(), 1u);
    EXPECT_EQ(excess(ray_query, {Of::ray_queries}).size(), 0u);
}

TEST(KernelNeeds, BeyondTheLimitsAreNamed) {
    const SpirvNeeds needs = {0x00010500, {1, 11}, {"SPV_A"}, 16896, 1024, 132};
    EXPECT_EQ(excess_of(needs, {}),
              (std::vector<std::string>{"capability 11", "SPV_A", "16896 bytes of shared memory; the limit is 16384",
                                        "1024 invocations of a group; the limit is 256",
                                        "132 bytes of push constants; the limit is 128"}));
}

}  // namespace
}  // namespace twinray
