// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/kernels/limits.h"
#include "cli/kernels/kernel_list.h"
#include "engine/accel/features_of.h"
#include "engine/core/error.h"

namespace twinray::kernels {
namespace {

using Faults = std::vector<std::string>;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

KernelRow row(const char* variant = "", const char* driver = "radv Mesa 26.2.6-1") {
    constexpr KernelFigures figures{96, 128, 10, 0, 512, 1000, 8000, 3};
    return {"navi21", driver, "trace", variant, figures, 64};
}

struct TemporaryFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("kernel_limits_" + std::to_string(getpid()));
    ~TemporaryFile() { std::filesystem::remove(path); }
    void write(const std::string& text) const { std::ofstream(path) << text; }
};

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
    EXPECT_EQ(grown(now, std::vector{row("old")}), Faults{"navi21: trace, new: there is no limit for it"});
    std::vector<KernelRow> of_other_device{row("new")};
    of_other_device[0].device = "navi31";
    EXPECT_EQ(grown(now, of_other_device).size(), 1);
}

TEST(KernelLimits, AnotherReleaseOfMesaIsToldAndNotCompared) {
    std::vector<KernelRow> now{row(), row("again")};
    for (KernelRow& grown_row : now) grown_row.figures.vgprs = 200;
    const auto limits_by = [](const char* driver) { return std::vector{row("", driver), row("again", driver)}; };
    EXPECT_EQ(not_comparable(now, limits_by("radv Mesa 26.1.6-1~bpo13+1")),
              Faults{"navi21: not compared: this is radv Mesa 26.2.6-1, the limits are of radv Mesa 26.1.6-1~bpo13+1"});
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
    const TemporaryFile file;
    file.write(R"({"device":"navi21","driver":"radv Mesa 26.2.6-1"})"
               "\n" +
               to_json(row("a b")).dump() + '\n');
    const std::vector<KernelRow> rows = read_rows(file.path);
    ASSERT_EQ(rows.size(), 1);
    EXPECT_EQ(rows[0].figures, row().figures);
    EXPECT_EQ(rows[0].variant, "a b");
    EXPECT_EQ(rows[0].driver, row().driver);
    EXPECT_EQ(rows[0].subgroup_size, 64);
}

TEST(KernelLimits, ADamagedFileIsNamedWithTheLine) {
    const TemporaryFile file;
    file.write("{}\n{\"kernel\":\n");
    try {
        read_rows(file.path);
        FAIL();
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), file.path.string() + "', line 2")) << error.what();
    }
    EXPECT_THROW(read_rows("/nowhere/limits.json"), Error);
    file.write(to_json(row()).dump() + '\n');
    EXPECT_THROW(read_rows(file.path), Error) << "no line says which driver";
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
