// SPDX-License-Identifier: MIT
#include "tests/support/device.h"

#include <cstdlib>
#include <string_view>

#include "engine/core/error.h"

namespace twinray::test {

bool is_required(const char* what) {
    const char* required = std::getenv("TWINRAY_REQUIRE");
    return required && std::string_view(required).find(what) != std::string_view::npos;
}

std::unique_ptr<Context> make_context(ContextDesc desc) {
    desc.validation = true;
    try {
        return std::make_unique<Context>(desc);
    } catch (const Error& error) {
        if (is_required("vulkan"))
            ADD_FAILURE() << "TWINRAY_REQUIRE names vulkan, but: " << error.what();
        else
            [&] { GTEST_SKIP() << error.what(); }();
        return nullptr;
    }
}

void VulkanTest::SetUp() {
    ContextDesc desc = context_desc();
    // Collected outside the context, so that what the layer says while it is destroyed counts too.
    desc.log = [this](std::string_view message) { log_.emplace_back(message); };
    context_ = make_context(desc);
    if (!context_ && HasFailure()) FAIL() << "no device";
}

bool VulkanTest::was_logged(const std::string& part) const {
    for (const std::string& message : log_)
        if (message.find(part) != std::string::npos) return true;
    return false;
}

void VulkanTest::TearDown() {
    if (!context_) return;
    const std::size_t logged = log_.size();
    for (const std::string& message : context_->validation_messages()) ADD_FAILURE() << message;
    context_.reset();
    for (std::size_t i = logged; i < log_.size(); ++i) ADD_FAILURE() << log_[i];
}

}  // namespace twinray::test
