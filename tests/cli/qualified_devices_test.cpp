#include "cli/qualified_devices.h"

#include <gtest/gtest.h>

namespace twinray::cli {
namespace {

DeviceProperties named(const char* name, const char* driver = "") {
    DeviceProperties device;
    device.name = name;
    device.driver = driver;
    return device;
}

std::vector<std::string> names_of(const std::vector<QualifiedDevice>& devices) {
    std::vector<std::string> names;
    for (const QualifiedDevice& device : devices) names.push_back(device.name);
    return names;
}

TEST(QualifiedDevices, LavapipeBelowMesa26HasEachWidthThatTheCpuHas) {
    const std::vector<DeviceProperties> devices = {named("NVIDIA H100 (SXM)"),
                                                   named("llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2")};
    const std::vector<std::string> narrow = {"0-NVIDIA-H100", "1-llvmpipe-128", "1-llvmpipe-256"};
    std::vector<std::string> wide = narrow;
    wide.push_back("1-llvmpipe-512");
    EXPECT_EQ(names_of(devices_to_qualify(devices, false, {})), narrow);
    EXPECT_EQ(names_of(devices_to_qualify(devices, true, {})), wide);
    EXPECT_EQ(devices_to_qualify(devices, true, {})[1].environment.at("LP_NATIVE_VECTOR_WIDTH"), "128");
}

TEST(QualifiedDevices, LavapipeFromMesa26OnHasTheWidthThatItChooses) {
    const std::vector<DeviceProperties> devices = {named("llvmpipe (LLVM 19.1.7, 256 bits)", "llvmpipe Mesa 26.1.6-1")};
    EXPECT_EQ(names_of(devices_to_qualify(devices, true, {})), std::vector<std::string>{"0-llvmpipe"});
    EXPECT_TRUE(devices_to_qualify(devices, true, {})[0].environment.empty());
}

TEST(QualifiedDevices, SwiftShaderJoinsUnlessTheLoaderHasIt) {
    const std::vector<DeviceProperties> without = {named("a GPU")}, with = {named("SwiftShader Device (LLVM 10)")};
    const std::vector<QualifiedDevice> joined = devices_to_qualify(without, false, "/icd.json");
    ASSERT_EQ(joined.size(), 2u);
    EXPECT_EQ(joined[1].environment.at("VK_DRIVER_FILES"), "/icd.json");
    EXPECT_EQ(devices_to_qualify(with, false, "/icd.json").size(), 1u);
    EXPECT_EQ(devices_to_qualify(without, false, {}).size(), 1u);
}

}  // namespace
}  // namespace twinray::cli
