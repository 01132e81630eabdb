// SPDX-License-Identifier: MIT
#include "engine/core/pipeline_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <span>

#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

namespace fs = std::filesystem;

VkPhysicalDeviceProperties driver_of(std::uint32_t version) {
    VkPhysicalDeviceProperties driver{};
    driver.vendorID = 0x10005;
    driver.deviceID = 7;
    driver.driverVersion = version;
    driver.pipelineCacheUUID[3] = 0xab;
    return driver;
}

Bytes pipelines_of(const VkPhysicalDeviceProperties& driver, std::size_t bytes) {
    VkPipelineCacheHeaderVersionOne header{
        sizeof header, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, driver.vendorID, driver.deviceID, {}};
    std::memcpy(header.pipelineCacheUUID, driver.pipelineCacheUUID, VK_UUID_SIZE);
    Bytes data(bytes, 42);
    const std::span<const std::byte> head = std::as_bytes(std::span(&header, 1));
    std::ranges::copy(head.first(std::min(bytes, head.size())), reinterpret_cast<std::byte*>(data.data()));
    return data;
}

class PipelineStoreTest : public testing::Test {
  protected:
    PipelineStore store(std::uint32_t version = 1) const { return {folder_, driver_of(version)}; }
    Bytes load(const PipelineStore& from) {
        return from.load([this](std::string_view sentence) { said_ += sentence; });
    }
    void save(const PipelineStore& to, const Bytes& data) {
        to.save(std::as_bytes(std::span(data)), [this](std::string_view sentence) { said_ += sentence; });
    }

    const test::TempDir temp_;
    const fs::path folder_ = temp_ / "deep";
    std::string said_;
};

TEST_F(PipelineStoreTest, GivesBackWhatItsDriverSaved) {
    const Bytes first = pipelines_of(driver_of(1), 1000), second = pipelines_of(driver_of(2), 50);
    EXPECT_TRUE(load(store()).empty());
    save(store(1), first);
    save(store(2), second);
    EXPECT_EQ(load(store(1)), first);
    EXPECT_EQ(load(store(2)), second);
    save(store(1), second);
    EXPECT_EQ(load(store(1)), second) << "replaced; both drivers have one UUID";
    EXPECT_EQ(said_, "");
}

TEST_F(PipelineStoreTest, RefusesWhatIsNotOfItsDriver) {
    VkPhysicalDeviceProperties other = driver_of(1);
    other.pipelineCacheUUID[15] = 1;
    save(store(), pipelines_of(driver_of(1), 100));
    const Bytes others = pipelines_of(other, 100);
    write_file(store().file(), std::array{std::as_bytes(std::span(others))});
    EXPECT_EQ(said_, "");
    EXPECT_TRUE(load(store()).empty());
    EXPECT_NE(said_.find("its pipelines are not of this driver"), std::string::npos) << said_;
    EXPECT_NE(said_.find(store().file().string()), std::string::npos) << said_;
}

// Mesa 26.2's lavapipe gives 20 bytes.
TEST_F(PipelineStoreTest, KeepsNothingThatItWouldRefuse) {
    for (const std::size_t bytes : {0u, 20u, 31u}) {
        save(store(), pipelines_of(driver_of(1), 100));
        save(store(), pipelines_of(driver_of(1), bytes));
        EXPECT_FALSE(fs::exists(store().file())) << bytes;
        EXPECT_TRUE(load(store()).empty());
    }
    EXPECT_EQ(said_, "");
}

TEST_F(PipelineStoreTest, IsBoundedInBytesAndFiles) {
    save(store(), pipelines_of(driver_of(1), 100));
    save(store(), pipelines_of(driver_of(1), PipelineStore::most_bytes + 1));
    EXPECT_FALSE(fs::exists(store().file()));

    fs::create_directories(folder_);
    std::ofstream(folder_ / "pipelines-of-somebody.txt") << "not ours";
    const auto now = fs::file_time_type::clock::now();
    for (std::uint32_t version = 1; version <= PipelineStore::most_files + 2; ++version) {
        save(store(version), pipelines_of(driver_of(version), 100));
        fs::last_write_time(store(version).file(), now - std::chrono::hours(100 - version));
    }
    EXPECT_FALSE(fs::exists(store(1).file()));
    EXPECT_FALSE(fs::exists(store(2).file()));
    EXPECT_TRUE(fs::exists(store(3).file()));
    EXPECT_TRUE(fs::exists(folder_ / "pipelines-of-somebody.txt"));
    EXPECT_EQ(said_, "");
}

TEST_F(PipelineStoreTest, SaysWhyItCannotSaveAndGoesOn) {
    fs::create_directories(folder_.parent_path());
    std::ofstream(folder_) << "a file where the folder should be";
    save(store(), pipelines_of(driver_of(1), 100));
    EXPECT_NE(said_, "");
    fs::remove(folder_);
}

TEST_F(PipelineStoreTest, NoFolderKeepsNothing) {
    const PipelineStore none(fs::path(), driver_of(1));
    save(none, pipelines_of(driver_of(1), 100));
    EXPECT_TRUE(load(none).empty());
    EXPECT_TRUE(none.file().empty());
}

}  // namespace
}  // namespace twinray
