#include "tests/support/device.h"

#include <cstdlib>
#include <string_view>

namespace twinray::test {

bool is_required(const char* what) {
    const char* required = std::getenv("TWINRAY_REQUIRE");
    return required && std::string_view(required).find(what) != std::string_view::npos;
}

bool has_validation() { return !std::getenv("TWINRAY_WITHOUT_VALIDATION"); }

std::unique_ptr<Context> make_context(ContextDesc desc) {
    desc.validation = has_validation();
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

namespace {

// A context that is kept for the tests to come.
struct SharedContext {
    std::shared_ptr<Context> context;
    std::shared_ptr<std::vector<std::string>> log;
    ContextDesc desc;

    bool fits(const ContextDesc& other) const {
        return other.use_ray_query == desc.use_ray_query &&
               other.use_ray_tracing_pipeline == desc.use_ray_tracing_pipeline && other.tuning == desc.tuning;
    }
};
std::vector<SharedContext> shared_contexts;  // the parameters of a suite alternate

// Lets the context go, and fails on messages meanwhile.
void let_go(SharedContext shared) {
    shared.log->clear();
    shared.context.reset();
    for (const std::string& message : *shared.log) ADD_FAILURE() << message;
}

class LetsGoOfSharedContexts : public ::testing::Environment {
    void TearDown() override {
        for (SharedContext& shared : std::exchange(shared_contexts, {})) let_go(std::move(shared));
    }
};
[[maybe_unused]] const auto* const lets_go = ::testing::AddGlobalTestEnvironment(new LetsGoOfSharedContexts);

}  // namespace

void VulkanTest::SetUp() {
    take_context();
    if (context_ && !HasFatalFailure()) prepare();
}

void VulkanTest::take_context() {
    ContextDesc desc = context_desc();
    // A test with a driver of its own, or with submissions cut short, shares no context.
    shares_ = shares_context() && !desc.get_instance_proc_addr && !desc.most_submission_seconds;
    for (const SharedContext& shared : shared_contexts)
        if (shares_ && shared.fits(desc)) {
            context_ = shared.context;
            log_ = shared.log;
            log_->clear();
            return;
        }
    log_ = std::make_shared<std::vector<std::string>>();
    desc.log = [log = log_](std::string_view message) { log->emplace_back(message); };
    context_ = make_context(desc);
    if (!context_ && HasFailure()) FAIL() << "no device";
    if (context_ && shares_) shared_contexts.push_back({context_, log_, desc});
}

bool VulkanTest::was_logged(const std::string& part) const {
    for (const std::string& message : *log_)
        if (message.find(part) != std::string::npos) return true;
    return false;
}

void VulkanTest::TearDown() {
    while (!kept_.empty()) kept_.pop_back();
    if (!context_) return;
    const std::size_t logged = log_->size();
    for (const std::string& message : context_->validation_messages()) ADD_FAILURE() << message;
    if (shares_ && HasFailure()) std::erase_if(shared_contexts, [&](const auto& it) { return it.context == context_; });
    context_.reset();
    for (std::size_t i = logged; i < log_->size(); ++i) ADD_FAILURE() << (*log_)[i];
}

}  // namespace twinray::test
