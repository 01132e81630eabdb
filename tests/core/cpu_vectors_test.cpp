// SPDX-License-Identifier: MIT
// What twinray's programs ask of Mesa's CPU driver before it is loaded.
#include "engine/core/cpu_vectors.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace twinray {
namespace {

std::optional<std::string> variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? std::optional<std::string>(value) : std::nullopt;
}
void set(const char* name, const std::optional<std::string>& value) {
    value ? setenv(name, value->c_str(), 1) : unsetenv(name);
}

class CpuVectors : public testing::Test {
  protected:
    CpuVectors() {
        for (std::size_t i = 0; i < names.size(); ++i) before_[i] = variable(names[i]);
        for (const char* name : names) unsetenv(name);
        caches_ = std::filesystem::path(testing::TempDir()) / "twinray_cpu_vectors";
        setenv("XDG_CACHE_HOME", caches_.c_str(), 1);
    }
    ~CpuVectors() override {
        for (std::size_t i = 0; i < names.size(); ++i) set(names[i], before_[i]);
        std::filesystem::remove_all(caches_);
    }
    std::filesystem::path caches_;

  private:
    static constexpr std::array names = {"LP_NATIVE_VECTOR_WIDTH", "MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME", "HOME"};
    std::optional<std::string> before_[names.size()];
};

TEST_F(CpuVectors, AreWidenedWhereTheCpuPrefersThat) {
    widen_cpu_vectors();
    if (!prefers_512_bit_vectors()) {
        EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), std::nullopt);
        EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), std::nullopt);
        return;
    }
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), "512");
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), caches_ / "twinray" / "mesa-512");
    EXPECT_TRUE(std::filesystem::is_directory(caches_ / "twinray" / "mesa-512"));
}

TEST_F(CpuVectors, KeepWhatTheUserHasSet) {
    setenv("LP_NATIVE_VECTOR_WIDTH", "128", 1);
    widen_cpu_vectors();
    EXPECT_EQ(variable("LP_NATIVE_VECTOR_WIDTH"), "128");
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), std::nullopt);
    unsetenv("LP_NATIVE_VECTOR_WIDTH");
    setenv("MESA_SHADER_CACHE_DIR", "mine", 1);
    widen_cpu_vectors();
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), "mine");
}

TEST_F(CpuVectors, NeedNoFolderForCaches) {
    unsetenv("XDG_CACHE_HOME");
    widen_cpu_vectors();
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), std::nullopt);
}

}  // namespace
}  // namespace twinray
