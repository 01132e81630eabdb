// SPDX-License-Identifier: MIT
// What twinray's programs ask of Mesa's CPU driver before it is loaded.
#include "engine/core/cpu_vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>

#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

using Text = std::optional<std::string>;

Text variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? Text(value) : std::nullopt;
}

constexpr std::array names = {"LP_NATIVE_VECTOR_WIDTH", "MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME", "HOME"};

// With an environment of its own.
class CpuVectors : public testing::Test {
  protected:
    CpuVectors() {
        for (std::size_t i = 0; i < names.size(); ++i) before_[i] = variable(names[i]);
        for (const char* name : names) unsetenv(name);
    }
    ~CpuVectors() override {
        for (std::size_t i = 0; i < names.size(); ++i)
            before_[i] ? setenv(names[i], before_[i]->c_str(), 1) : unsetenv(names[i]);
    }
    test::TempDir caches_;

  private:
    std::array<Text, names.size()> before_;
};

TEST_F(CpuVectors, AreWidenedWhereThatIsPreferredAndCodeHasAFolder) {
    const auto folder = folder_of_wide_code(true, false, caches_ / "twinray");
    ASSERT_TRUE(folder);
    EXPECT_TRUE(std::filesystem::is_directory(*folder));
    EXPECT_EQ(folder_of_wide_code(true, false, caches_ / "twinray"), folder) << "again";
    EXPECT_EQ(folder_of_wide_code(false, false, caches_ / "twinray"), std::nullopt);
    EXPECT_EQ(folder_of_wide_code(true, true, caches_ / "twinray"), std::nullopt);
    EXPECT_EQ(folder_of_wide_code(true, false, {}), std::nullopt);
    EXPECT_EQ(folder_of_wide_code(true, false, caches_.write("file", "no folder")), std::nullopt);
}

TEST_F(CpuVectors, AreSetInTheEnvironmentWithTheFolder) {
    setenv("XDG_CACHE_HOME", (caches_ / "").c_str(), 1);
    widen_cpu_vectors();
    const bool is_preferred = prefers_512_bit_vectors() && std::ranges::any_of(list_devices(), takes_any_vector_width);
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), is_preferred ? Text("512") : std::nullopt);
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), is_preferred ? Text(caches_ / "twinray" / "mesa-512") : std::nullopt);
}

TEST_F(CpuVectors, StayAsTheUserHasThem) {
    setenv("XDG_CACHE_HOME", (caches_ / "").c_str(), 1);
    setenv("LP_NATIVE_VECTOR_WIDTH", "128", 1);
    widen_cpu_vectors();
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), "128");
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), std::nullopt);
    unsetenv("LP_NATIVE_VECTOR_WIDTH");
    setenv("MESA_SHADER_CACHE_DIR", "mine", 1);
    widen_cpu_vectors();
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), std::nullopt) << "code of both widths would meet there";
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), "mine");
}

TEST_F(CpuVectors, StayWithoutAFolderForCaches) {
    widen_cpu_vectors();
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), std::nullopt);
}

}  // namespace
}  // namespace twinray
