// Vulkan devices for tests: validation is on (core and synchronisation) and any message fails the test.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <twinray/commands.h>
#include "engine/core/context.h"
#include "tests/support/errors.h"

namespace twinray::test {

// Returns whether tests must fail rather than skip without this: TWINRAY_REQUIRE is a list of such names as
// `vulkan`, `ray_tracing` or `embree`: the first arguments of TWINRAY_LACKS, and more in tests that are scripts.
bool is_required(const char* what);
// Returns whether contexts have the validation layer, as they do unless TWINRAY_WITHOUT_VALIDATION is set: Wine has no
// layers.
bool has_validation();

// Leaves a test that needs what this machine lacks; under TWINRAY_REQUIRE with that name it fails.
#define TWINRAY_LACKS(what, reason)                                           \
    do {                                                                      \
        if (::twinray::test::is_required(what)) {                             \
            FAIL() << "TWINRAY_REQUIRE names " << (what) << ": " << (reason); \
        } else {                                                              \
            GTEST_SKIP() << (reason);                                         \
        }                                                                     \
    } while (false)

// Makes a validated context, or returns null if this machine has no usable device: then the test has been skipped, or
// failed if TWINRAY_REQUIRE names vulkan. Callers return at once on null.
std::unique_ptr<Context> make_context(ContextDesc desc = {});

// Submits commands with one pass, which `record` fills.
template <class Record>
SyncPoint submit_pass(Context& context, const std::string& name, const Record& record) {
    Commands commands(context, name);
    {
        const auto pass = commands.pass(name);
        record(commands);
    }
    return commands.submit();
}
// Uploads values, which a span must be able to hold, to the start of a buffer.
template <class Values>
SyncPoint upload_to(Context& context, const Buffer& buffer, const Values& values) {
    return submit_pass(context, "test input",
                       [&](Commands& commands) { commands.upload(buffer, 0, std::as_bytes(std::span(values))); });
}
// Returns a buffer on the device with these values.
template <class Values>
Buffer device_copy(Context& context, const Values& values) {
    Buffer buffer(context, {.name = "test input", .bytes = std::as_bytes(std::span(values)).size()});
    upload_to(context, buffer, values);
    return buffer;
}

// The fixture for label `vulkan`.
class VulkanTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;  // fails on validation messages
    // Makes what the test needs, where there is a device, or leaves it by TWINRAY_LACKS.
    virtual void prepare() {}
    // Makes what lives until the test is over, and goes before the context does.
    template <class T, class... Args>
    T& keep(Args&&... args) {
        const auto made = std::make_shared<T>(std::forward<Args>(args)...);
        kept_.push_back(made);
        return *made;
    }
    virtual ContextDesc context_desc() const { return {}; }
    // Tests share the context of the one before, with all that it compiled, if that has the same features; not if they
    // test a context itself or count its contents.
    virtual bool shares_context() const { return true; }
    Context& context() const { return *context_; }
    template <class Values>
    Buffer device_copy(const Values& values) const {
        return test::device_copy(context(), values);
    }
    // Returns whether a warning that contains this has come.
    bool was_logged(const std::string& part) const;

  private:
    void take_context();

    bool shares_ = false;
    std::shared_ptr<Context> context_;
    std::vector<std::shared_ptr<void>> kept_;
    std::shared_ptr<std::vector<std::string>> log_;  // outlives the context, whose last messages count as well
};

}  // namespace twinray::test
