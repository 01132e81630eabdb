// A set of three types: kernels read what the host wrote, and both find the same elements by the same keys.
#include <twinray/sets.h>

#include "engine/core/kernel.h"
#include "test_set.spv.h"
#include "test_set_debug.spv.h"
#include "tests/scene/set_kernel_shared.h"
#include "tests/support/caller.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"

namespace twinray {
namespace {

using namespace test;

Diffuse diffuse(float x) { return {vec3(x, x + 1, x + 2), 0.5f * x}; }
Glass glass(float x) { return {x}; }
Layered layered(float x) { return {uvec2(0, 9), vec4(x), vec4(x), vec4(3 * x)}; }

struct ValueOf {
    template <class T>
    float operator()(const T& element, float x) const {
        return value_of(element, x);
    }
};

class MultiTypeSetTest : public VulkanTest {
  protected:
    bool shares_context() const override { return false; }  // the tests count memory
    void prepare() override { set_ = &keep<Materials>(context(), "materials"); }
    Materials& set() { return *set_; }

    Kernel<SetTestArgs> kernel(bool is_debug = false) {
        const std::span<const uint> modules[] = {test_set_spirv, test_set_debug_spirv};
        return {context(), {.name = "test_set", .spirv = modules[is_debug]}};
    }
    // Returns the kernel's results: a value for each key, the weighted sum, the results of unrolled loops.
    std::vector<float> run(const std::vector<SetKey>& keys, bool is_debug = false) {
        const std::size_t size = keys.size() + 1 + UNROLLED_RESULTS;
        const Buffer on_device = device_copy(keys);
        const Buffer values(context(), {.name = "values", .bytes = size * sizeof(float)});
        Commands commands(context(), "test set");
        const auto count = static_cast<uint>(keys.size());
        kernel(is_debug).dispatch(commands, {set().view(), on_device.ref<SetKey>(), values.ref<float>(), count, 0},
                                  std::max(count, 1u));
        commands.submit();
        return download<float>(context(), values, size);
    }
    // Lets a kernel double the ior of all glass.
    void double_glass() {
        Commands commands(context(), "double glass");
        kernel().dispatch(commands, {set().view(), {}, {}, 0, 1}, set().size<Glass>());
        commands.submit();
    }

  private:
    Materials* set_ = nullptr;
};

TEST_F(MultiTypeSetTest, KeysCountTheElementsOfEachType) {
    EXPECT_EQ(set().size(), 0u);
    EXPECT_FALSE(is_valid(SetKey{}));
    const SetKey first = set().push(diffuse(1)), other = set().push(glass(2)), second = set().push(diffuse(3));
    EXPECT_EQ(std::vector({first.type, first.index, other.type, other.index, second.type, second.index}),
              std::vector({1u, 0u, 2u, 0u, 1u, 1u}));
    EXPECT_TRUE(is_valid(first));
    EXPECT_EQ(set().slots(), 3u);
    EXPECT_EQ(set().size(), 3u);
    EXPECT_EQ(set().size<Diffuse>(), 2u);
    EXPECT_EQ(set().size<Layered>(), 0u);
    EXPECT_EQ(set().get<Diffuse>(second).color, vec3(3, 4, 5));
    EXPECT_TRUE(set().contains(second));
    for (const SetKey none : {SetKey{}, SetKey{1, 2}, SetKey{3, 0}, SetKey{4, 0}, SetKey{~0u, ~0u}})
        EXPECT_FALSE(set().contains(none));
    static_assert(Materials::holds<Glass> && !Materials::holds<float>);
}

TEST_F(MultiTypeSetTest, KeysThatNameNothingAreRefusedAndChangeNothing) {
    const SetKey key = set().push(glass(2)), more{2, 1}, most{2, 7};
    set().sync();
    EXPECT_EQ(error_if_any([&] { set().update(SetKey{}, glass(9)); }),
              "materials: update: the key is (type 0, index 0), where types go from 1 to 3; wanted is type 2");
    EXPECT_EQ(error_if_any([&] { set().update(more, glass(9)); }),
              "materials: update: the key is (type 2, index 1), where type 2 is glass, of which there are 1; wanted is "
              "type 2");
    EXPECT_EQ(error_if_any([&] { set().update(key, diffuse(9)); }),
              "materials: update: the key is (type 2, index 0), where type 2 is glass, of which there are 1; wanted is "
              "type 1");
    EXPECT_NE(error_if_any([&] { set().get<Glass>({4, 0}); }), "");
    EXPECT_EQ(error_if_any([&] { with_index(ValueOf{}, set(), most, 1.0f); }),
              "with_index: the key is (type 2, index 7), where type 2 is glass, of which there are 1");
    EXPECT_EQ(set().get<Glass>(key).ior, 2.0f);
    EXPECT_EQ(error_if_any([&] { set().view(); }), "") << "an edit is pending";
}

// Compares values of all keys, of keys that name nothing, the sum over all elements and the unrolled loops.
TEST_F(MultiTypeSetTest, HostAndKernelsFindTheSame) {
    std::mt19937 random(5);
    std::vector<SetKey> keys;
    for (uint i = 0; i < 500; ++i) {
        const float x = static_cast<float>(random() % 64);
        const auto type = random() % 3;
        keys.push_back(type == 0 ? set().push(diffuse(x)) : type == 1 ? set().push(glass(x)) : set().push(layered(x)));
    }
    std::shuffle(keys.begin(), keys.end(), random);
    const std::size_t valid = keys.size();
    for (const SetKey none : {SetKey{}, SetKey{0, 3}, SetKey{1, 500}, SetKey{2, ~0u}, SetKey{4, 0}, SetKey{~0u, 0}})
        keys.push_back(none);
    set().sync();
    const std::vector<float> values = run(keys);
    for (std::size_t i = 0; i < keys.size(); ++i)
        EXPECT_EQ(values[i], i < valid ? with_index(ValueOf{}, set(), keys[i], static_cast<float>(i)) : FALLBACK) << i;

    float sum = 0;
    foreach_element([](const auto& element, std::size_t i,
                       float& total) { total += weight_of(static_cast<uint>(i)) * value_of(element, 1.0f); },
                    set(), sum);
    EXPECT_EQ(values[keys.size()], sum);

    const std::tuple tuple{set().get<Diffuse>({1, 0}), set().get<Glass>({2, 0}), set().get<Layered>({3, 0})};
    float folded = 0;
    for_unrolled([](const auto& e, float& total) { total = 3 * total + value_of(e, 1.0f); }, tuple, folded);
    const auto [a, b, c] = map_unrolled(ValueOf{}, tuple, 2.0f);
    const float reduced =
        reduce_unrolled([](float total, const auto& e) { return 10 * total + value_of(e, 2.0f); }, tuple, 1.0f);
    const std::vector<float> expected{folded,   a,
                                      b,        c,
                                      reduced,  sum_unrolled(ValueOf{}, tuple, 2.0f),
                                      FALLBACK, get_unrolled(ValueOf{}, tuple, 1, 4.0f),
                                      FALLBACK};
    EXPECT_EQ(std::vector(values.begin() + static_cast<std::ptrdiff_t>(keys.size()) + 1, values.end()), expected);
}

TEST_F(MultiTypeSetTest, KernelsForDebuggingTellOfKeysThatNameNothing) {
    const SetKey key = set().push(glass(2));
    set().sync();
    run({key, {2, 1}});
    set().check_faults();  // other kernels do not tell
    EXPECT_EQ(run({key}, true).front(), -2.0f);
    set().check_faults();
    EXPECT_EQ(run({{2, 8}}, true).front(), FALLBACK);
    run({key, {}, {2, 1}, {9, 0}}, true);
    EXPECT_EQ(error_if_any([&] { set().check_faults(); }),
              "materials: kernels met 4 keys that name nothing, the first is (type 2, index 8), where type 2 is glass, "
              "of which there are 1");
}

TEST_F(MultiTypeSetTest, AnUpdateUploadsItsElementAloneAndViewsStay) {
    std::vector<SetKey> keys;
    for (uint i = 0; i < 100; ++i) keys.push_back(set().push(glass(static_cast<float>(i))));
    set().push(layered(1));
    set().sync();
    const TestSet before = set().view();
    double_glass();
    set().update(keys[7], glass(500));
    set().update(keys[7], glass(600));
    set().update(keys[8], glass(700));
    EXPECT_EQ(error_if_any([&] { set().view(); }), "materials: view: edits are pending; call sync() first");
    set().sync();
    const TestSet after = set().view();
    EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0);
    const std::vector<float> values = run(keys);
    for (uint i = 0; i < 100; ++i) {
        const float ior = i == 7 ? 600.0f : i == 8 ? 700.0f : 2.0f * static_cast<float>(i);
        EXPECT_EQ(values[i], static_cast<float>(i) - ior) << "what the kernel wrote was uploaded over, or lost";
    }
    EXPECT_EQ(set().get<Glass>(keys[5]).ior, 5.0f) << "the host's copy is what the host wrote";
    EXPECT_EQ(set().download<Glass>()[5].ior, 10.0f);
    EXPECT_EQ(set().download<Layered>().size(), 1u);
    EXPECT_TRUE(set().download<Diffuse>().empty());
}

TEST_F(MultiTypeSetTest, WhatKernelsWroteMovesAlongWhenAnArrayGrows) {
    std::vector<SetKey> keys{set().push(glass(3)), set().push(glass(4))};
    set().sync();
    double_glass();
    const TestSet before = set().view();
    for (int i = 0; i < 1000; ++i) keys.push_back(set().push(glass(5)));
    set().sync();
    EXPECT_TRUE(set().view().glass.address != before.glass.address);
    const std::vector<float> values = run(keys);
    EXPECT_EQ(values[0], 0.0f - 6.0f);
    EXPECT_EQ(values[1], 1.0f - 8.0f);
    EXPECT_EQ(values[1001], 1001.0f - 5.0f);
}

TEST_F(MultiTypeSetTest, TheRevisionCountsSyncsThatBringElements) {
    EXPECT_EQ(set().revision(), 0u);
    EXPECT_EQ(set().view().glass_count, 0u);
    const SetKey key = set().push(glass(1));
    EXPECT_EQ(set().revision(), 0u);
    set().sync();
    EXPECT_EQ(set().revision(), 1u);
    EXPECT_TRUE(set().view().revision == 1);
    set().update(key, glass(2));
    set().sync();
    EXPECT_EQ(set().revision(), 1u);
    set().push(glass(3));  // there is room for it
    set().update(key, glass(4));
    set().sync();
    EXPECT_EQ(set().revision(), 2u);
    EXPECT_EQ(set().view().glass_count, 2u);
}

TEST_F(MultiTypeSetTest, ACleanSyncDoesNothing) {
    EXPECT_EQ(set().sync().value, 0u);
    set().push(glass(1));
    const SyncPoint done = set().sync();
    context().wait_for_gpu();
    const std::uint64_t bytes = context().allocated_bytes();
    for (int i = 0; i < 100; ++i) EXPECT_EQ(set().sync().value, done.value);
    EXPECT_EQ(context().last_submission().value, done.value);
    EXPECT_EQ(context().allocated_bytes(), bytes);
}

TEST_F(MultiTypeSetTest, TenThousandPushesAndUpdatesLeakNothing) {
    std::mt19937 random(6);
    std::vector<SetKey> keys;
    std::uint64_t most = 0;
    const std::uint64_t start = context().allocated_bytes();
    for (int i = 0; i < 10'000; ++i) {
        if (random() % 2 || keys.empty())
            keys.push_back(set().push(layered(static_cast<float>(i))));
        else
            set().update(keys[random() % keys.size()], layered(static_cast<float>(i % 1000)));
        if (i % 20 == 0) set().sync();
        if (i % 1000 == 0) context().wait_for_gpu();
        most = std::max(most, context().allocated_bytes());
    }
    set().sync();
    context().wait_for_gpu();
    const std::uint64_t held = context().allocated_bytes() - start;
    EXPECT_EQ(held, 8192 * sizeof(Layered)) << "a power of two times 16 that " << keys.size() << " fit in";
    EXPECT_LT(most - start, 4 * held);
    const std::vector<float> values = run(keys);
    for (std::size_t i = 0; i < keys.size(); ++i)
        ASSERT_EQ(values[i], with_index(ValueOf{}, set(), keys[i], static_cast<float>(i)));
}

TEST_F(MultiTypeSetTest, SyncsIntoTheCallersCommands) {
    Caller caller(context());
    const SetKey key = set().push(glass(1));
    Commands own(context(), "own");
    set().sync(own);
    own.submit();
    EXPECT_EQ(run({key}).front(), -1.0f);
    for (int frame = 0; frame < 3; ++frame) {
        const SyncPoint last = context().last_submission();
        const CallerCommands buffer = caller.record("frame", [&](Commands& commands) {
            set().update(key, glass(static_cast<float>(frame)));
            if (frame == 2)
                for (int i = 0; i < 100; ++i) set().push(glass(1));  // the array grows
            set().sync(commands);
        });
        EXPECT_EQ(context().last_submission().value, last.value) << "the set submitted something itself";
        caller.submit(buffer);
        context().wait(buffer.done);
        EXPECT_EQ(run({key}).front(), static_cast<float>(-frame));
    }
}

class MultiTypeSetFault : public MultiTypeSetTest {
  protected:
    ContextDesc context_desc() const override { return {.get_instance_proc_addr = injector_.entry()}; }
    faults::FaultInjector injector_;
};

TEST_F(MultiTypeSetFault, ASyncThatFailsChangesNothingAndTheNextOneWorks) {
    const SetKey key = set().push(glass(1));
    set().sync();
    for (const char* function : {"vkCreateBuffer", "vkQueueSubmit"}) {
        const std::uint64_t revision = set().revision();
        set().update(key, glass(3));
        const SetKey more = [&] {
            SetKey last;
            for (int i = 0; i < 40; ++i) last = set().push(glass(4));
            return last;
        }();
        injector_.inject({.function = function});
        EXPECT_NE(error_if_any([&] { set().sync(); }), "") << function;
        injector_.heal();
        EXPECT_EQ(set().revision(), revision);
        EXPECT_NE(error_if_any([&] { set().view(); }), "");
        set().sync();
        EXPECT_EQ(run({key, more})[0], -3.0f);
        EXPECT_EQ(run({key, more})[1], 1.0f - 4.0f);
    }
}

}  // namespace
}  // namespace twinray
