// SPDX-License-Identifier: MIT
// Vulkan devices for tests: validation is on (core and synchronisation) and any message fails the test.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>

#include <twinray/commands.h>
#include "engine/core/context.h"

namespace twinray::test {

// Returns whether tests must fail rather than skip without this: TWINRAY_REQUIRE is a list of `vulkan`, `ray_tracing`,
// `embree`, `avif`, `links`, `spirv_tools`.
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

// Returns a buffer on the device with these values, which a span must be able to hold.
template <class Values>
Buffer device_copy(Context& context, const Values& values) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
    Buffer buffer(context, {.name = "test input", .bytes = bytes.size()});
    Commands commands(context, "test input");
    {
        const auto pass = commands.pass("test input");
        commands.upload(buffer, 0, bytes);
    }
    commands.submit();
    return buffer;
}

// The fixture for label `vulkan`.
class VulkanTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;  // fails on validation messages
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
    bool shares_ = false;
    std::shared_ptr<Context> context_;
    std::shared_ptr<std::vector<std::string>> log_;  // outlives the context, whose last messages count as well
};

}  // namespace twinray::test
