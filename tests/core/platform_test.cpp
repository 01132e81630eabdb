// Features that each system implements in its own way: starting programs, folders, memory; and the pipelines that are
// kept in a folder.
#include "engine/core/platform.h"

#include <cstdlib>

#include "engine/core/pipelines.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

const std::vector<std::string> hard_words = {"a b", "", "\"", "a\\", "a\\\\\"b c\\\\", "*", "100%", "$HOME", "\t"};

// Runs in the process that the tests below start, and does what its environment says.
TEST(PlatformChild, DoesWhatItIsTold) {
    const char* const told = std::getenv("TWINRAY_TEST_CHILD");
    const std::string what = told ? told : "";
    const std::vector<std::string> words = ::testing::internal::GetArgvs();
    if (what == "words") std::_Exit(std::ranges::search(words, hard_words).empty() ? 1 : 42);
    if (what == "abort") std::abort();
}

std::optional<platform::ProgramEnd> child(const std::string& what) {
    std::vector<std::string> words = {"--gtest_filter=PlatformChild.*"};
    words.insert(words.end(), hard_words.begin(), hard_words.end());
    return platform::run_program({{}, words, {{"TWINRAY_TEST_CHILD", what}, {"GTEST_OUTPUT", ""}}, /*is_silent*/ true});
}

TEST(Platform, AProgramGetsItsWordsAndVariablesAndItsStatusComesBack) {
    const auto end = child("words");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->fault, "");
    EXPECT_EQ(end->status, 42);
}

TEST(Platform, AProgramThatTheSystemEndsIsToldFromOneThatEnds) {
    const auto whole = child("nothing"), aborted = child("abort");
    ASSERT_TRUE(whole && aborted);
    EXPECT_EQ(whole->fault, "");
    EXPECT_EQ(whole->status, 0);
    constexpr int status_of_abort_on_windows = 3;
    EXPECT_TRUE(!aborted->fault.empty() || aborted->status == status_of_abort_on_windows) << aborted->status;
}

TEST(Platform, AProgramThatIsNotThereIsNotStarted) {
    EXPECT_FALSE(platform::run_program({"no such program of twinray"}));
    platform::become_program({"no such program of twinray"});  // returns
}

TEST(Platform, ThisProgramIsAFile) { EXPECT_TRUE(std::filesystem::is_regular_file(platform::this_program())); }

TEST(Platform, TemporaryFoldersAreNewAndTakeFilesOfAnyName) {
    const test::TempDir a, b;
    EXPECT_NE(a / "", b / "");
    const std::string name =
        "K\xc3\xa4"
        "fig \xe2\x82\xac";
    EXPECT_EQ(a.write(name, "x").filename().string(), name);
    EXPECT_TRUE(std::filesystem::exists(a / name));
}

TEST(Platform, MappedMemoryIsToldFromOther) {
    const int here = 0;
    EXPECT_TRUE(platform::is_mapped(reinterpret_cast<std::uint64_t>(&here)));
    EXPECT_FALSE(platform::is_mapped(std::uint64_t{1} << 50)) << "beyond all addresses of programs";
}

TEST(Platform, SecondsOfProcessorsGrow) {
    const auto before = platform::processor_seconds();
    if (!before) GTEST_SKIP() << "the system does not tell";
    const auto after = platform::processor_seconds();
    EXPECT_GE(after->all, before->all);
    EXPECT_GE(after->own, before->own);
    EXPECT_LE(after->busy, after->all);
}

TEST(Platform, NobodyListensAtPort1) { EXPECT_FALSE(platform::Connection::open("127.0.0.1", "1", 1)); }

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
    VkPipelineCacheHeaderVersionOne first{
        sizeof first, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, driver.vendorID, driver.deviceID, {}};
    std::memcpy(first.pipelineCacheUUID, driver.pipelineCacheUUID, VK_UUID_SIZE);
    Bytes data(bytes, 42);
    const std::span<const std::byte> head = std::as_bytes(std::span(&first, 1));
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
