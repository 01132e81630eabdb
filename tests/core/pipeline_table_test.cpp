// SPDX-License-Identifier: MIT
#include "engine/core/pipeline_table.h"

#include "engine/core/kernel.h"
#include "engine/core/radix_sort.h"
#include <twinray/tlas.h>
#include "tests/support/device.h"
#include "test_nothing.spv.h"

namespace twinray {
namespace {

struct NoArgs {
    uint value;
};

class PipelineTableTest : public test::VulkanTest {
  protected:
    bool shares_context() const override { return false; }
    std::size_t size() { return context().state().pipelines().size(); }
    // Constants that a shader does not have are ignored, but make another pipeline.
    KernelDesc desc(uint constant) {
        return {.name = "nothing", .spirv = test_nothing_spirv, .constants = {{77, constant}}};
    }
};

TEST_F(PipelineTableTest, EqualKernelsShareAPipeline) {
    const std::size_t before = size();
    const Kernel<NoArgs> first(context(), desc(1'000'001)), second(context(), desc(1'000'001));
    EXPECT_EQ(size(), before + 1);
    const Kernel<NoArgs> other_constant(context(), desc(1'000'002));
    EXPECT_EQ(size(), before + 2);
    struct Two {
        uint value[2];
    };
    const Kernel<Two> other_args(context(), desc(1'000'001));
    EXPECT_EQ(size(), before + 3);
}

TEST_F(PipelineTableTest, PipelinesOutliveTheirKernels) {
    const auto build = [&] {
        SwTlas accel(context());
        accel.push(make_icosphere(1));
        accel.sync();
    };
    build();
    const std::size_t before = size();
    EXPECT_GT(before, 0u);
    build();
    EXPECT_EQ(size(), before);
}

TEST_F(PipelineTableTest, LaterKernelsCompileWhenTheyAreUsed) {
    const std::size_t before = size();
    KernelDesc later = desc(2'000'000);
    later.compiles_when_used = true;
    const Kernel<NoArgs> kernel(context(), later);
    EXPECT_EQ(size(), before);
    Commands commands(context(), "nothing");
    kernel.dispatch(commands, {0}, 1);
    commands.submit();
    EXPECT_EQ(size(), before + 1);
}

TEST_F(PipelineTableTest, TheOldestUnusedOnesGo) {
    const Kernel<NoArgs> in_use(context(), desc(3'000'000));
    for (uint i = 1; i <= PipelineTable::most_unused + 10; ++i) {
        Commands commands(context(), "nothing");
        const Kernel<NoArgs> kernel(context(), desc(3'000'000 + i));
        kernel.dispatch(commands, {0}, 1);
        commands.submit();
    }
    const std::size_t full = size();
    EXPECT_GE(full, PipelineTable::most_unused);
    { const Kernel<NoArgs> another(context(), desc(4'000'000)); }
    EXPECT_EQ(size(), full) << "one came, one went";
    const auto is_kept = [&](uint constant) {
        const Kernel<NoArgs> kernel(context(), desc(constant));
        return size() == full;
    };
    EXPECT_TRUE(is_kept(3'000'000)) << "in use";
    EXPECT_TRUE(is_kept(3'000'000 + PipelineTable::most_unused + 10)) << "the newest";
    EXPECT_FALSE(is_kept(3'000'001)) << "the oldest";
}

}  // namespace
}  // namespace twinray
