// Kernels: equal ones share a pipeline, and none gets an address that cannot be read. Every VulkanTest checks that for
// each dispatch, by a validation message; here the message is seen to come.
#include "engine/core/pipelines.h"

#include <twinray/tlas.h>
#include "engine/accel/trace_desc.h"
#include "engine/core/kernel.h"
#include "swtlas_trace.spv.h"
#include "test_nothing.spv.h"
#include "tests/support/device.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

const KernelAddress& named(const std::vector<KernelAddress>& addresses, const std::string& name) {
    for (const KernelAddress& address : addresses)
        if (address.name.ends_with(name)) return address;
    throw Error(text("no address '", name, "'"));
}

TEST(KernelAddresses, AreFoundInAModule) {
    const std::vector<KernelAddress> found = kernel_addresses(swtlas_trace_spirv);
    EXPECT_EQ(found.size(), 4u);  // scene and user_data are of type Address
    EXPECT_EQ(named(found, "rays").offset, offsetof(TraceArgs, rays));
    EXPECT_EQ(named(found, "hits").offset, offsetof(TraceArgs, hits));
    EXPECT_EQ(named(found, "indirect_count").offset, offsetof(TraceArgs, indirect_count));
    EXPECT_EQ(named(found, "order").offset, offsetof(TraceArgs, order));
}

TraceArgs readable(Context& context, const TraceArgs& args) {
    const std::vector<std::byte> bytes =
        readable_args(context, "a kernel", kernel_addresses(swtlas_trace_spirv), std::as_bytes(std::span(&args, 1)));
    TraceArgs result;
    std::memcpy(&result, bytes.data(), sizeof(result));
    return result;
}

using KernelAddressesOnDevice = test::VulkanTest;

TEST_F(KernelAddressesOnDevice, ThatAreAbsentCanBeRead) {
    const Buffer rays(context(), {.name = "rays", .bytes = sizeof(Ray)});
    TraceArgs args{};
    args.rays = rays.ref<Ray>();
    args.count = 7;
    const TraceArgs given = readable(context(), args);
    EXPECT_EQ(VkDeviceAddress{given.rays.address}, rays.address());
    EXPECT_EQ(VkDeviceAddress{given.order.address}, context().absent());
    EXPECT_EQ(VkDeviceAddress{given.indirect_count.address}, context().absent());
    EXPECT_EQ(given.count, 7u);
    EXPECT_TRUE(is_absent(given.order));
    EXPECT_FALSE(is_absent(given.rays));
}

TEST(KernelAddressesOfACpu, ThatCannotBeReadAreNamed) {
    if (!test::has_validation()) TWINRAY_LACKS("validation", "TWINRAY_WITHOUT_VALIDATION is set");
    const std::unique_ptr<Context> context = test::make_context({.log = [](std::string_view) {}});
    if (!context) return;
    if (context->properties().kind != DeviceKind::cpu)
        TWINRAY_LACKS("host_addresses", "needs a device with addresses of the host");
    TraceArgs args{};
    args.order.address = 64;
    readable(*context, args);
    const std::vector<std::string> messages = context->validation_messages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("kernel 'a kernel': nothing can be read at 'args.order', address 64"), std::string::npos)
        << messages[0];
}

TEST_F(KernelAddressesOnDevice, OfWhatIsAbsentLeadBackToIt) {
    if (context().properties().kind != DeviceKind::cpu)
        TWINRAY_LACKS("host_addresses", "needs a device with addresses of the host");
    std::uint64_t part = 0;
    for (const std::uint64_t offset : {0, 8, 64, 1024}) {
        std::memcpy(&part, reinterpret_cast<const void*>(context().absent() + offset), sizeof(part));
        EXPECT_EQ(part, context().absent());
    }
}

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
