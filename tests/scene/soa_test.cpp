// Structures of arrays: host and kernels read and write the same items, and items out of range stay as they were.
#include <twinray/sets.h>

#include "engine/core/kernel.h"
#include "test_soa.spv.h"
#include "test_soa_debug.spv.h"
#include "tests/scene/set_kernel_shared.h"
#include "tests/support/device.h"

namespace twinray {
namespace {

using namespace test;

#include "twinray/glsl/cpp_begin.h"
#define PLAIN_FIELDS(X, P) X(P, 0, vec3, a) X(P, 1, uint, b) X(P, 2, vec4, c)
TWINRAY_SOA_VIEW(PlainView, PLAIN_FIELDS)
#include "twinray/glsl/cpp_end.h"
using PlainFields = SoaFields<PlainView PLAIN_FIELDS(TWINRAY_LIST_ENTRY, 0)>;

TEST(SoaFields, ArraysFollowEachOtherAligned) {
    EXPECT_EQ(PlainFields::offsets(5), (std::array<std::uint64_t, 4>{0, 64, 96, 176}));
    EXPECT_EQ(PlainFields::offsets(0).back(), 0u);
    EXPECT_EQ(PlainFields::offsets(1u << 31)[1], std::uint64_t{12} << 31) << "64 bits";
}

TEST(HostSoa, GetsWhatWasSetAndRefusesOtherIndices) {
    HostQueue queue(10);
    const TestQueue view = queue.view();
    for (uint i = 0; i < 10; ++i) {
        soa_set(view, i, &TestQueue::origin, vec3(static_cast<float>(i)));
        soa_set(view, i, &TestQueue::pixel, i + 1);
    }
    for (uint i = 0; i < 10; ++i) {
        EXPECT_EQ(soa_get(view, i, &TestQueue::origin), vec3(static_cast<float>(i)));
        EXPECT_EQ(soa_get(view, i, &TestQueue::pixel), i + 1);
        EXPECT_EQ(soa_get(view, i, &TestQueue::t), 0.0f);
    }
    EXPECT_EQ(error_if_any([&] { soa_get(view, 10, &TestQueue::t); }), "soa_get: index 10 of 10 items");
    EXPECT_EQ(error_if_any([&] { soa_set(view, ~0u, &TestQueue::t, 1); }), "soa_set: index 4294967295 of 10 items");
    HostQueue longer = similar_soa(queue, 20);
    EXPECT_EQ(longer.count(), 20u);
    EXPECT_EQ(soa_get(longer.view(), 19, &TestQueue::pixel), 0u);
}

class SoaTest : public VulkanTest {
  protected:
    void run(const Queue& from, const Queue& to, uint invocations, uint shift, bool is_debug = false) {
        const std::span<const uint> modules[] = {test_soa_spirv, test_soa_debug_spirv};
        const Kernel<SoaTestArgs> kernel(context(), {.name = "test_soa", .spirv = modules[is_debug]});
        Commands commands(context(), "soa");
        kernel.dispatch(commands, {from.view(), to.view(), invocations, shift}, invocations);
        commands.submit();
    }
};

TEST_F(SoaTest, KernelsMoveItemsAndLeaveAloneWhatIsOutOfRange) {
    constexpr uint count = 1000, shift = 300;
    const Queue from(context(), "from", count);
    const Queue to = similar_soa(from, count - 100);
    ASSERT_EQ(to.count(), 900u);
    HostQueue expected(to.count());
    std::vector<vec3> origins;
    std::vector<uint> pixels;
    std::vector<float> ts;
    std::vector<Diffuse> materials;
    for (uint i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i);
        origins.push_back(vec3(x, -x, 2 * x));
        pixels.push_back(3 * i);
        ts.push_back(0.5f * x);
        materials.push_back({vec3(x), 4 * x});
    }
    submit_pass(context(), "upload", [&](Commands& commands) {
        from.upload(commands, &TestQueue::origin, std::span<const vec3>(origins));
        from.upload(commands, &TestQueue::pixel, std::span<const uint>(pixels).first(500));
        from.upload(commands, &TestQueue::pixel, std::span<const uint>(pixels).subspan(500), 500);
        from.upload(commands, &TestQueue::t, std::span<const float>(ts));
        from.upload(commands, &TestQueue::material, std::span<const Diffuse>(materials));
    });
    run(from, to, count, shift);
    const std::vector<vec3> moved_origins = to.download(&TestQueue::origin);
    const std::vector<uint> moved_pixels = to.download(&TestQueue::pixel);
    const std::vector<float> moved_ts = to.download(&TestQueue::t);
    const std::vector<Diffuse> moved_materials = to.download(&TestQueue::material);
    ASSERT_EQ(moved_pixels.size(), 900u);
    for (uint i = 0; i < to.count(); ++i) {
        const bool is_there = i + shift < count;
        EXPECT_EQ(moved_origins[i], (is_there ? origins[i + shift] : vec3(FALLBACK)) + 1.0f) << i;
        EXPECT_EQ(moved_pixels[i], is_there ? pixels[i + shift] : 77u) << i;
        EXPECT_EQ(moved_ts[i], 2 * (is_there ? ts[i + shift] : FALLBACK)) << i;
        EXPECT_EQ(moved_materials[i].gain, is_there ? materials[i + shift].gain : FALLBACK) << i;
    }
    EXPECT_EQ(from.download(&TestQueue::pixel), pixels) << "a write out of range reached another buffer";
    from.check_faults();
    to.check_faults();
}

TEST_F(SoaTest, KernelsForDebuggingTellOfIndicesOutOfRange) {
    const Queue from(context(), "from", 100), to(context(), "to", 90);
    run(from, to, 90, 0, true);
    from.check_faults();
    to.check_faults();
    run(from, to, 1, 150, true);
    EXPECT_EQ(error_if_any([&] { from.check_faults(); }),
              "from: kernels met 4 indices out of range, the first is 150 of 100 items");
    run(from, to, 100, 0, true);
    expect_error("to: kernels met 40 indices out of range", [&] { to.check_faults(); });
}

TEST_F(SoaTest, UploadsBeyondTheLastItemAreRefused) {
    const Queue queue(context(), "queue", 10);
    const std::vector<float> values(8);
    Commands commands(context(), "upload");
    const auto pass = commands.pass("upload");
    EXPECT_EQ(error_if_any([&] { queue.upload(commands, &TestQueue::t, std::span<const float>(values), 3); }),
              "queue: upload: 8 items from 3 exceed its 10");
    EXPECT_NE(error_if_any([&] { queue.upload(commands, &TestQueue::t, std::span<const float>(values), ~0u); }), "");
}

TEST_F(SoaTest, AnEmptyOneIsAllowed) {
    const Queue from(context(), "from", 0), to(context(), "to", 0);
    run(from, to, 64, 0);
    EXPECT_TRUE(from.download(&TestQueue::t).empty());
}

}  // namespace
}  // namespace twinray
