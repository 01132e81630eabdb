// The list of kernels: it forgets no module of the library or the path tracer, and nothing runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cli/kernels/kernels.h"
#include "engine/core/commands.h"
#include "engine/core/error.h"
#include "engine/core/spirv_words.h"
#include "kernel_modules.h"
#include "tests/support/device.h"

namespace twinray::kernels {
namespace {

constexpr std::uint32_t gl_compute = 5;

bool is_compute(spirv::Words module) {
    for (std::size_t at = spirv::header_words; at < module.size(); at += spirv::words_of(module[at]))
        if (spirv::op_of(module[at]) == spirv::Op::EntryPoint) return module[at + 1] == gl_compute;
    return false;
}

// Compares words, since rows may be of modules that another translation unit has a copy of.
bool lists(const KernelList& list, std::span<const std::uint32_t> spirv) {
    return std::ranges::any_of(
        list.kernels, [&](const ListedKernel& kernel) { return std::ranges::equal(kernel.desc.spirv, spirv); });
}

class KernelListTest : public ::testing::Test {
  protected:
    void SetUp() override { device_ = test::make_context(); }
    bool has_device() const { return device_ != nullptr; }
    const DeviceProperties& properties() const { return device_->properties(); }

  private:
    std::unique_ptr<Context> device_;
};

TEST_F(KernelListTest, HoldsEveryComputeModule) {
    if (!has_device()) return;
    if (!properties().ray_query) TWINRAY_LACKS("ray_tracing", "modules of the hardware accelerator need ray queries");
    const KernelList list = list_kernels({});
    const std::string_view of_other_tuning =
        list.context->state().tuning().has_wide_loads ? "swtlas_trace" : "swtlas_trace_int64";
    std::size_t count = 0;
    for (const auto& [name, spirv] : kernel_modules) {
        if (!is_compute(spirv) || name == of_other_tuning) continue;
        ++count;
        EXPECT_TRUE(lists(list, spirv)) << name << ": no kernel of the list is made of it";
    }
    EXPECT_GT(count, 60);
}

TEST_F(KernelListTest, NamesTellKernelsApart) {
    if (!has_device()) return;
    std::set<std::pair<std::string, std::string>> names;
    for (const ListedKernel& kernel : list_kernels({}).kernels) {
        EXPECT_TRUE(names.emplace(kernel.name, kernel.variant).second) << kernel.name << ' ' << kernel.variant;
        EXPECT_EQ(kernel.variant.find('#'), std::string::npos) << kernel.name << ' ' << kernel.variant;
    }
}

TEST_F(KernelListTest, ADeviceOnWhichNothingRunsIsDoneAtOnce) {
    if (!has_device()) return;
    std::vector<std::string> made;
    ContextDesc desc;
    desc.watch_kernels = [&](const KernelDesc& kernel, std::uint32_t) { made.push_back(kernel.name); };
    Context context(desc);
    const Buffer buffer(context, {.name = "numbers", .bytes = 8});
    const Buffer other(context, {.name = "others", .bytes = 8});
    EXPECT_NE(buffer.address(), other.address());
    Commands commands(context, "fill");
    {
        const auto pass = commands.pass("fill");
        commands.fill(buffer, 0, 8, 1);
    }
    EXPECT_TRUE(context.is_reached(commands.submit()));
    EXPECT_EQ(download<uint>(context, buffer, 2), std::vector<uint>({0, 0}));
    EXPECT_TRUE(made.empty());
}

TEST_F(KernelListTest, StatisticsNeedAContextOnWhichNothingRuns) {
    if (!has_device()) return;
    const KernelDesc desc{.name = "nothing", .spirv = kernel_modules[0].spirv};
    Context runs;
    EXPECT_THROW(compile_for_statistics(runs, desc, 4), Error);
}

}  // namespace
}  // namespace twinray::kernels
