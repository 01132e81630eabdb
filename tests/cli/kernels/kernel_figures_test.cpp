// Figures of compiled kernels: as drivers report them, against limits, in tables; and the names of variants.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/kernels/kernels.h"
#include "engine/accel/trace_desc.h"
#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"

namespace twinray::kernels {
namespace {

std::uint64_t u(std::uint64_t value) { return value; }

TEST(KernelStatistics, RadvsWordsAreMapped) {
    const std::vector<Statistic> told = {{"Driver pipeline hash", u(17073026995690029095u)},
                                         {"SGPRs", u(128)},
                                         {"VGPRs", u(108)},
                                         {"Spilled VGPRs", u(2)},
                                         {"Spilled SGPRs", u(1)},
                                         {"Code size", u(7528)},
                                         {"LDS size", u(4096)},
                                         {"Scratch size", u(19456)},
                                         {"Subgroups per SIMD", u(14)},
                                         {"Instructions", u(1421)},
                                         {"Pre-Sched VGPRs", u(90)}};
    const KernelFigures expected{108, 128, 14, 19456, 4096, 1421, 7528, 3};
    EXPECT_EQ(figures_of(told), expected);
}

// Mesa 26.1 and 26.2 report these names.
TEST(KernelStatistics, NvksWordsAreMapped) {
    const std::vector<Statistic> told = {{"Instruction count", u(1657)}, {"Static cycle count", u(158327)},
                                         {"Max warps/SM", u(16)},        {"Spills to memory", u(2)},
                                         {"Fills from memory", u(4)},    {"Spills to reg", u(29)},
                                         {"Fills from reg", u(10)},      {"Code size", u(26512)},
                                         {"Number of GPRs", u(104)},     {"SLM size", u(16)}};
    const KernelFigures expected{104, {}, 16, 16, {}, 1657, 26512, 31};
    EXPECT_EQ(figures_of(told), expected);
}

TEST(KernelStatistics, TurnipsWordsAreMapped) {
    const std::vector<Statistic> told = {{"Max Waves Per Core", u(10)},
                                         {"Instruction Count", u(1015)},
                                         {"Code size", u(1536)},
                                         {"NOPs Count", u(278)},
                                         {"Registers used", u(19)},
                                         {"Half-registers used", u(0)},
                                         {"STP Count", u(5)},
                                         {"LDP Count", u(7)},
                                         {"Preamble Instruction Count", u(15)}};
    const KernelFigures expected{19, {}, 10, {}, {}, 1015, 6144, 5};
    EXPECT_EQ(figures_of(told), expected);
}

TEST(KernelStatistics, OtherDriversWordsAreMapped) {
    const std::vector<Statistic> nvidia = {{"Register Count", u(40)}, {"Binary Size", u(900)}};
    EXPECT_EQ(figures_of(nvidia).vgprs, 40);
    EXPECT_EQ(figures_of(nvidia).code_bytes, 900);
    const std::vector<Statistic> anv = {{"Instruction Count", 70.0}, {"Scratch Memory Size", std::int64_t{0}}};
    EXPECT_EQ(figures_of(anv).instructions, 70);
    EXPECT_EQ(figures_of(anv).scratch_bytes, 0);
}

TEST(KernelStatistics, WhatIsNotToldIsEmpty) {
    EXPECT_EQ(figures_of({}), KernelFigures{});
    const std::vector<Statistic> odd = {{"VGPRs", std::int64_t{-1}}, {"Instructions", double{NAN}}, {"Hash", u(7)}};
    EXPECT_EQ(figures_of(odd), KernelFigures{});
}

using Faults = std::vector<std::string>;

KernelRow row(const char* variant = "", const char* driver = "radv Mesa 26.2.6-1") {
    constexpr KernelFigures figures{96, 128, 10, 0, 512, 1000, 8000, 3};
    return {"navi21", driver, "trace", variant, figures, 64};
}

TEST(KernelLimits, EqualRowsAndInstructionsWithinTheMarginAreFine) {
    std::vector<KernelRow> now{row()};
    now[0].figures.instructions = 1020;
    now[0].figures.waves = 1;
    EXPECT_EQ(grown(now, std::vector{row()}), Faults{});
}

TEST(KernelLimits, EachFigureThatGrowsIsTold) {
    const std::vector<KernelRow> limits{row()};
    const auto faults_with = [&](auto KernelFigures::*figure, std::uint64_t value) {
        std::vector<KernelRow> now{row()};
        now[0].figures.*figure = value;
        return grown(now, limits);
    };
    EXPECT_EQ(faults_with(&KernelFigures::vgprs, 97), Faults{"navi21: trace: 97 registers, at most 96"});
    EXPECT_EQ(faults_with(&KernelFigures::scratch_bytes, 1), Faults{"navi21: trace: 1 bytes of scratch, at most 0"});
    EXPECT_EQ(faults_with(&KernelFigures::shared_bytes, 513),
              Faults{"navi21: trace: 513 bytes of shared memory, at most 512"});
    EXPECT_EQ(faults_with(&KernelFigures::spills, 4), Faults{"navi21: trace: 4 spills, at most 3"});
    EXPECT_EQ(faults_with(&KernelFigures::instructions, 1021),
              Faults{"navi21: trace: 1021 instructions, at most 1020"});
}

TEST(KernelLimits, ARowWithoutALimitIsTold) {
    const std::vector<KernelRow> now{row("new")};
    EXPECT_EQ(grown(now, std::vector{row("old")}), Faults{"navi21: trace, new: no limit is recorded"});
    std::vector<KernelRow> of_other_device{row("new")};
    of_other_device[0].device = "navi31";
    EXPECT_EQ(grown(now, of_other_device).size(), 1);
}

TEST(KernelLimits, AnotherReleaseOfMesaIsToldAndNotCompared) {
    std::vector<KernelRow> now{row(), row("again")};
    for (KernelRow& grown_row : now) grown_row.figures.vgprs = 200;
    const auto limits_by = [](const char* driver) { return std::vector{row("", driver), row("again", driver)}; };
    EXPECT_EQ(not_comparable(now, limits_by("radv Mesa 26.1.6-1~bpo13+1")),
              Faults{"navi21: not compared: the driver is radv Mesa 26.2.6-1, but the limits are from radv Mesa "
                     "26.1.6-1~bpo13+1"});
    EXPECT_EQ(grown(now, limits_by("radv Mesa 26.1.6-1~bpo13+1")), Faults{});
    for (const char* driver : {"radv Mesa 26.2.0", ""}) {
        EXPECT_EQ(not_comparable(now, limits_by(driver)), Faults{});
        EXPECT_EQ(grown(now, limits_by(driver)).size(), 2) << driver;
    }
    EXPECT_EQ(mesa_release_of("turnip Mesa driver Mesa 26.2.6-1"), "26.2");
    EXPECT_EQ(mesa_release_of("NVIDIA 580.95.05"), "");
}

TEST(KernelLimits, WhatOneSideDoesNotTellIsNotCompared) {
    std::vector<KernelRow> silent{row()};
    silent[0].figures = {};
    EXPECT_EQ(grown(silent, std::vector{row()}), Faults{});
    EXPECT_EQ(grown(std::vector{row()}, silent), Faults{});
}

TEST(KernelLimits, RowsAreReadAsTheyWereWritten) {
    const test::TempDir folder;
    const std::string driver = R"({"device":"navi21","driver":"radv Mesa 26.2.6-1"})";
    const auto rows = read_rows(folder.write("limits.json", driver + '\n' + to_json(row("a b")).dump() + '\n'));
    ASSERT_EQ(rows.size(), 1);
    EXPECT_EQ(rows[0].figures, row().figures);
    EXPECT_EQ(rows[0].variant, "a b");
    EXPECT_EQ(rows[0].driver, row().driver);
    EXPECT_EQ(rows[0].subgroup_size, 64);
}

TEST(KernelLimits, ADamagedFileIsNamedWithTheLine) {
    const test::TempDir folder;
    const std::filesystem::path file = folder.write("limits.json", "{}\n{\"kernel\":\n");
    test::expect_error(file.string() + "', line 2", [&] { read_rows(file); });
    EXPECT_THROW(read_rows("/nowhere/limits.json"), Error);
    folder.write("limits.json", to_json(row()).dump() + '\n');
    EXPECT_THROW(read_rows(file), Error) << "no line says which driver";
}

TEST(KernelLimits, TablesLeaveEmptyWhatIsNotTold) {
    std::vector<KernelRow> rows{row("fast")};
    rows[0].figures.waves.reset();
    EXPECT_EQ(table_of(rows),
              "kernel  specialisation  VGPR  waves  scratch  shared  spills  instructions\n"
              "trace   fast              96               0     512       3          1000\n");
}

TEST(KernelVariant, SaysWhatConstantsChoose) {
    const auto variant = [](const char* name, std::vector<SpecializationConstant> constants) {
        return variant_of({.name = name, .spirv = {}, .constants = std::move(constants)});
    };
    const uint features = FEATURE_COMPRESSED8 | FEATURE_INSTANCES;
    EXPECT_EQ(variant("trace", {{RAY_GROUP_CONSTANT, 64}, {FEATURES_CONSTANT, features}, {LEVEL_CONSTANT, LEVEL_FAST}}),
              "compressed8 instances fast");
    EXPECT_EQ(variant("trace", {{FEATURES_CONSTANT, FEATURES_ALL}, {LEVEL_CONSTANT, LEVEL_CERTIFIED}}),
              "everything certified");
    EXPECT_EQ(variant("swtlas_hierarchy", {{1, 64}, {0, 1}}), "high");
    EXPECT_EQ(variant("path_tracer_shade", {{2, 1}, {1, 0}}), "glass");
}

}  // namespace
}  // namespace twinray::kernels
