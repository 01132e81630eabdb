// Contexts, their buffers and passes, and memory that two of them share.
#include "engine/core/context.h"

#include "engine/core/commands.h"
#include "tests/accel/accel_fixture.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

class ContextTest : public test::VulkanTest {
  protected:
    bool shares_context() const override { return false; }
};

TEST(ContextErrors, AnUnknownDeviceIsNamedWithTheReasons) {
    if (!test::make_context()) return;
    const std::string error = test::error_of([] { const Context context({.device = "no such device"}); });
    test::expect_contains(error, "no usable Vulkan device");
    test::expect_contains(error, "'no such device'");
}

TEST(ContextErrors, AnIncompleteAdoptionIsRefused) { EXPECT_THROW(Context(AdoptedDevice{}), Error); }

TEST(ContextPipelines, AreKeptBetweenRuns) {
    if (!test::make_context()) return;
    const test::TempDir temp;
    const std::filesystem::path folder = temp / "pipelines";
    std::string said;
    const ContextDesc desc{.pipeline_folder = folder, .log = [&](std::string_view line) { said += line; }};
    for (int run = 0; run < 2; ++run) {
        Context context(desc);
        SwTlas accel(context);
        accel.push(make_icosphere(0));
        accel.sync();
    }
    EXPECT_EQ(said, "") << "what the first run wrote is of the driver of the second";
    const auto files = std::filesystem::directory_iterator(folder);
    const auto count = std::distance(begin(files), end(files));
    if (count == 0) TWINRAY_LACKS("pipeline_caches", "this driver gives a pipeline cache without Vulkan's header");
    ASSERT_EQ(count, 1);
    const std::filesystem::path file = std::filesystem::directory_iterator(folder)->path();
    std::ofstream(file) << "damaged";
    { const Context context(desc); }
    EXPECT_NE(said.find("its pipelines are not of this driver"), std::string::npos) << said;
    EXPECT_GE(std::filesystem::file_size(file), sizeof(VkPipelineCacheHeaderVersionOne)) << "written anew";
}

TEST_F(ContextTest, UploadsAndDownloads) {
    std::vector<uint> values(1000);
    for (uint i = 0; i < 1000; ++i) values[i] = i * i;
    const Buffer buffer(context(), {.name = "values", .bytes = 4000});
    Commands commands(context(), "upload");
    {
        const auto pass = commands.pass("upload");
        commands.upload(buffer, std::span<const uint>(values));
    }
    commands.submit();
    EXPECT_EQ(download<uint>(context(), buffer, 1000), values);
    EXPECT_EQ(download<uint>(context(), buffer, 10, 400),
              std::vector<uint>(values.begin() + 100, values.begin() + 110));
}

TEST_F(ContextTest, CopiesBeyondABufferAreRefused) {
    const Buffer buffer(context(), {.name = "small", .bytes = 16});
    Commands commands(context(), "upload");
    const std::vector<uint> five(5);
    EXPECT_THROW(commands.upload(buffer, std::span<const uint>(five)), Error);
    EXPECT_THROW(download<uint>(context(), buffer, 5), Error);
}

TEST_F(ContextTest, ABufferNeedsAName) { EXPECT_THROW(Buffer(context(), {.name = "", .bytes = 16}), Error); }

TEST_F(ContextTest, MemoryIsFreedAfterTheWorkThatMayUseIt) {
    constexpr std::uint64_t bytes = 64 << 20;
    context().wait_for_gpu();
    const std::uint64_t before = context().allocated_bytes();
    SyncPoint filled;
    {
        const Buffer buffer(context(), {.name = "temporary", .bytes = bytes});
        Commands commands(context(), "fill");
        for (std::uint32_t word = 0; word < 50; ++word) {
            const auto pass = commands.pass("fill");
            commands.fill(buffer, 0, bytes, word);
        }
        filled = commands.submit();
    }
    Commands(context(), "collects").submit();
    ASSERT_FALSE(context().is_reached(filled)) << "the fills were over too soon to show anything";
    EXPECT_GE(context().allocated_bytes(), before + bytes) << "freed while the GPU may write it";
    context().wait_for_gpu();
    EXPECT_EQ(context().allocated_bytes(), before);
}

TEST_F(ContextTest, PassesAreTimedByName) {
    const Buffer buffer(context(), {.name = "filled", .bytes = 1 << 20});
    Commands commands(context(), "fill");
    {
        const auto pass = commands.pass("first");
        commands.fill(buffer, 0, 1 << 20, 1);
    }
    {
        const auto pass = commands.pass("second");
        commands.fill(buffer, 0, 1 << 20, 2);
    }
    commands.submit();
    const std::vector<PassTiming> timings = commands.timings();
    ASSERT_EQ(timings.size(), 2u);
    EXPECT_EQ(timings[0].name, "first");
    EXPECT_EQ(timings[1].name, "second");
    EXPECT_GT(timings[0].ms, 0);
    EXPECT_EQ(download<uint>(context(), buffer, 1, 400).front(), 2u);
}

TEST_F(ContextTest, PassesDoNotNest) {
    Commands commands(context(), "nested");
    const auto outer = commands.pass("outer");
    EXPECT_THROW(static_cast<void>(commands.pass("inner")), Error);
}

// The fixture must see what the layer says, or "validation is silent" means nothing.
TEST(Validation, IsHeard) {
    if (!test::has_validation()) TWINRAY_LACKS("validation", "TWINRAY_WITHOUT_VALIDATION is set");
    std::vector<std::string> messages;
    ContextDesc desc;
    desc.log = [&](std::string_view message) { messages.emplace_back(message); };
    const std::unique_ptr<Context> context = test::make_context(desc);
    if (!context) return;
    VkBufferCreateInfo wrong{};
    wrong.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;  // size 0 and no usage are both forbidden
    const auto create = reinterpret_cast<PFN_vkCreateBuffer>(
        context->state().vk().vkGetDeviceProcAddr(context->device(), "vkCreateBuffer"));
    const auto destroy = reinterpret_cast<PFN_vkDestroyBuffer>(
        context->state().vk().vkGetDeviceProcAddr(context->device(), "vkDestroyBuffer"));
    VkBuffer buffer = VK_NULL_HANDLE;
    create(context->device(), &wrong, nullptr, &buffer);
    destroy(context->device(), buffer, nullptr);
    EXPECT_FALSE(context->validation_messages().empty());
    EXPECT_FALSE(messages.empty());
}

using test::down;
using test::expect_error;
using test::square;

class SharedMemory : public test::AccelTest {
  protected:
    void write(Context& other, const Buffer& buffer, const std::vector<vec3>& positions) {
        Commands commands(other, "other program");
        {
            const auto pass = commands.pass("write");
            commands.upload(buffer, std::span<const vec3>(positions));
        }
        other.wait(commands.submit());
    }
};
TWINRAY_OVER_EVERY_ACCEL(SharedMemory);

TEST_P(SharedMemory, AMeshOfAnotherDeviceIsTracedAndFollowsIt) {
    if (!context().properties().external_memory)
        TWINRAY_LACKS("external_memory", text("no ", platform::shared_memory.extension));
    const auto other = test::make_context();
    if (!other) return;
    Mesh mesh = square(0);
    const Buffer theirs = Buffer::exportable(*other, {.name = "theirs", .bytes = mesh.positions.size() * sizeof(vec3)});
    write(*other, theirs, mesh.positions);
    const Buffer ours = Buffer::imported(context(), {.name = "ours", .bytes = theirs.bytes()}, theirs.exported());
    EXPECT_EQ(download<vec3>(context(), ours, mesh.positions.size()), mesh.positions);
    const Buffer indices = device_copy(mesh.triangles);
    const AccelHandle handle = accel().push(DeviceMesh{.name = "shared",
                                                       .positions = ours.address(),
                                                       .vertex_count = mesh.positions.size(),
                                                       .indices = indices.address(),
                                                       .triangle_count = mesh.triangles.size(),
                                                       .in_place = true});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
    for (vec3& p : mesh.positions) p.z = 3;
    write(*other, theirs, mesh.positions);
    accel().mark_vertices_dirty(handle);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 7.0f);
}

TEST_P(SharedMemory, WhatCannotBeSharedIsRefused) {
    if (!context().properties().external_memory)
        TWINRAY_LACKS("external_memory", text("no ", platform::shared_memory.extension));
    const Buffer own(context(), {.name = "own", .bytes = 64});
    expect_error("buffer 'own' is not exportable", [&] { own.exported(); });
    expect_error("buffer 'mapped' to be shared: only memory of the device",
                 [&] { Buffer::exportable(context(), {.name = "mapped", .bytes = 64, .memory = Memory::upload}); });
    expect_error("no handle", [&] { Buffer::imported(context(), {.name = "none", .bytes = 64}, {}); });
    const Buffer small = Buffer::exportable(context(), {.name = "small", .bytes = 64});
    const ExportedMemory exported = small.exported();
    expect_error("bytes were exported; 1048576 are needed",
                 [&] { Buffer::imported(context(), {.name = "large", .bytes = 1 << 20}, exported); });
    const std::intptr_t copy = platform::copy_handle(exported.handle);
    EXPECT_NE(copy, platform::no_handle) << "the handle is no longer the caller's";
    for (const std::intptr_t handle : {copy, exported.handle}) platform::close_handle(handle);
}

}  // namespace
}  // namespace twinray
