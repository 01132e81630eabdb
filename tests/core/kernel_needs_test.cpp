// SPDX-License-Identifier: MIT
// Every SPIR-V module of the build declares no more than the table of requirements says of the parts of twinray that it
// belongs to, so that no device is asked for what a scene does not need.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "engine/core/requirement.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/sort_args.h"
#include "tests/support/spirv_needs.h"

namespace twinray {
namespace {

using Of = Requirement::Of;
using Parts = std::set<Of>;

// By how a module's name begins, with the folder of its shader or the name of its kernel; the first that fits counts.
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
const std::map<std::string, Of> words = {{"hw", Of::ray_queries},           {"rahit", Of::ray_pipelines},
                                         {"rint", Of::ray_pipelines},       {"refined", Of::refinement},
                                         {"int64", Of::int64_kernels},      {"images", Of::images},
                                         {"culling", Of::primitive_culling}};

Parts parts_of_words(const std::string& module) {
    Parts parts;
    std::istringstream name(module);
    for (std::string word; std::getline(name, word, '_');)
        if (const auto found = words.find(word); found != words.end()) parts.insert(found->second);
    return parts;
}

Parts parts_of(const std::string& module) {
    const auto family = std::ranges::find_if(families, [&](const Family& f) { return module.starts_with(f.begin); });
    if (family == std::end(families)) fail("it belongs to no known part of twinray");
    Parts parts = parts_of_words(module);
    parts.insert(family->parts.begin(), family->parts.end());
    return parts;
}

// Tutorials name their kernels as a reader would, so that their folder is their family.
Parts parts_of_file(const std::filesystem::path& file) {
    const std::string name = file.stem().string();
    return file.string().find("/samples/tutorials/") == std::string::npos ? parts_of(name) : parts_of_words(name);
}

// The values that the host gives them for a GPU; for a CPU's driver it asks the device (KernelTuning). Groups that have
// as many invocations as a vector has lanes are at their largest.
std::map<std::uint32_t, std::uint32_t> constants_of(const std::string& module) {
    if (module.starts_with("engine_sort_scan")) return {{GROUP_SIZE_CONSTANT, SCAN_GPU_GROUP}};
    if (module.starts_with("engine_sort"))
        return {{GROUP_SIZE_CONSTANT, SORT_GPU_GROUP}, {DIGIT_BITS_CONSTANT, SORT_GPU_DIGIT_BITS}};
    return {{GROUP_SIZE_CONSTANT, KernelLimits::group_invocations}};
}

// One sentence for each thing that the module needs and its parts may not.
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
    for (const std::filesystem::path& file : modules) {
        const std::string name = file.stem().string();
        try {
            const SpirvNeeds needs = needs_of(words_of(file), constants_of(name));
            for (const std::string& excess : excess_of(needs, parts_of_file(file)))
                ADD_FAILURE() << name << ": " << excess;
        } catch (const Error& error) {
            ADD_FAILURE() << name << ": " << error.what();
        }
    }
}

TEST(KernelNeeds, AModuleOfNoKnownPartFails) {
    EXPECT_THROW(parts_of("volume_march"), Error);
    EXPECT_EQ(parts_of("hwtlas_trace_query_refined"), (Parts{Of::ray_queries, Of::refinement}));
    EXPECT_EQ(parts_of("all_hits_sw"), Parts{});
    EXPECT_EQ(parts_of("test_program_rint"), Parts{Of::ray_pipelines});
    EXPECT_EQ(parts_of_file("build/samples/tutorials/09_moving_scenes/spirv/picture_hw.spv"), Parts{Of::ray_queries});
    EXPECT_THROW(parts_of_file("build/samples/volume/spirv/march.spv"), Error);
}

// As the rows of the table stand: what no kernel uses is in none, float64 and rays only in theirs.
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

// A module by hand: groups of 8 x COLUMNS, for each invocation a vec3 and a number that they share; 132 bytes of push
// constants.
TEST(KernelNeeds, AreReadFromAModule) {
    constexpr auto op = [](std::uint32_t code, std::uint32_t length) { return length << 16 | code; };
    // An instruction or two a line.
    // clang-format off
    const std::vector<std::uint32_t> spirv = {
        0x07230203, 0x00010500, 0, 40, 0,
        op(17, 2), 1, op(17, 2), 11,                                // OpCapability Shader, Int64
        op(10, 3), 0x5f565053, 0x00000041,                          // OpExtension "SPV_A"
        op(16, 6), 30, 17, 1, 1, 1,                                 // OpExecutionMode LocalSize 1 1 1
        op(71, 4), 5, 1, 7,                                         // OpDecorate %5 SpecId 7
        op(71, 4), 6, 11, 25,                                       // OpDecorate %6 BuiltIn WorkgroupSize
        op(72, 5), 20, 0, 35, 128,                                  // OpMemberDecorate %20 0 Offset 128
        op(21, 4), 1, 32, 0, op(23, 4), 2, 1, 3,                    // %1 uint, %2 uvec3
        op(43, 4), 1, 3, 8, op(43, 4), 1, 4, 1,                     // %3 8, %4 1
        op(50, 4), 1, 5, 2, op(51, 6), 2, 6, 3, 5, 4,               // %5 COLUMNS, by default 2, %6 (8, COLUMNS, 1)
        op(52, 6), 1, 7, 132, 3, 5, op(28, 4), 8, 2, 7,             // %7 8 * COLUMNS, %8 uvec3[8 * COLUMNS]
        op(52, 6), 1, 9, 81, 6, 1, op(28, 4), 10, 1, 9,             // %9 %6.y, %10 uint[COLUMNS]
        op(32, 4), 11, 4, 8, op(32, 4), 12, 4, 10,                  // pointers
        op(59, 4), 11, 13, 4, op(59, 4), 12, 14, 4,                 // OpVariable Workgroup
        op(30, 3), 20, 1, op(32, 4), 21, 9, 20, op(59, 4), 21, 22, 9};
    // clang-format on
    SpirvNeeds needs = needs_of(spirv);
    EXPECT_EQ(needs.capabilities, (std::set<std::uint32_t>{1, 11}));
    EXPECT_EQ(needs.extensions, std::set<std::string>{"SPV_A"});
    EXPECT_EQ(needs.group_invocations, 16u);
    EXPECT_EQ(needs.shared_bytes, 16u * 16 + 16);
    EXPECT_EQ(needs.push_constant_bytes, 132u);
    needs = needs_of(spirv, {{7, 128}});
    EXPECT_EQ(needs.group_invocations, 1024u);
    EXPECT_EQ(needs.shared_bytes, 1024u * 16 + 128 * 4);
    EXPECT_EQ(excess_of(needs, {}),
              (std::vector<std::string>{"capability 11", "SPV_A", "16896 bytes of shared memory; the limit is 16384",
                                        "1024 invocations of a group; the limit is 256",
                                        "132 bytes of push constants; the limit is 128"}));
}

}  // namespace
}  // namespace twinray
