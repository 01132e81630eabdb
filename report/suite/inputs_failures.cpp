// SPDX-License-Identifier: MIT
// Vulkan fails under the library, one call at a time or for ever.
#include <algorithm>

#include "report/faults/fault_injection.h"
#include "report/suite/sections.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

using faults::Fault;
using faults::FaultInjector;

// A context, an accelerator and its hits. The result of a failing call is kept, so that it can be tried again.
class Session {
  public:
    Session(const Devices& devices, const Configuration& configuration, const FaultInjector& vulkan)
        : desc_(devices.desc(configuration.backend)),
          backend_(configuration.backend),
          options_(devices.options(configuration, devices.trees().layout)) {
        desc_.get_instance_proc_addr = vulkan.entry();
        desc_.validation = false;  // the layer knows nothing of a loss that is only reported
        desc_.log = [](std::string_view) {};
        options_.compiles_in_background = false;  // calls are counted in one thread
    }

    void make_context() {
        if (!context_) context_ = std::make_unique<Context>(desc_);
    }

    // Makes what does not exist yet.
    std::vector<Hit> hits(const World& world, std::span<const Ray> rays) {
        make_context();
        if (!accel_) accel_ = Devices::make_accel(*context_, backend_, options_);
        for (const AccelHandle handle : accel_->handles()) accel_->erase(handle);
        world.fill(*accel_);
        return accel_->closest_hits(rays);
    }

    void end() {
        accel_.reset();
        context_.reset();
    }

  private:
    ContextDesc desc_;
    Backend backend_;
    AccelOptions options_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<AbstractAccel> accel_;
};

// The part of a run in which calls fail.
enum class FailingPart : std::uint8_t {
    context,  // its creation
    session,  // all from the context to the hits
    trace     // build and trace in a session that has done so before
};
const char* name_of(FailingPart part) {
    return part == FailingPart::context ? "context" : part == FailingPart::session ? "session" : "build and trace";
}

class FailingRuns {
  public:
    FailingRuns(CaseRun& run, const Configuration& configuration)
        : run_(run), configuration_(configuration), session_(run.devices(), configuration, vulkan_) {}

    // Lets calls fail by `fault`, at most `most`, evenly chosen among those of the part, and records the results.
    void fail(FailingPart part, Fault fault, std::size_t most) {
        if (most == 0) return;
        const std::uint64_t calls = count_calls(part, fault);
        CaseRun::Outcome outcome{.params = {{"failing", fault.result == VK_ERROR_DEVICE_LOST ? "the device" : "a call"},
                                            {"during", name_of(part)}},
                                 .results = {{"calls", calls}},
                                 .n = std::min<std::uint64_t>(most, calls),
                                 .fault_of = "twinray"};
        for (std::uint64_t i = 0; i < outcome.n; ++i) {
            fault.first = 1 + i * calls / outcome.n;
            const std::string wrong = what_is_wrong_with(part, fault);
            if (!wrong.empty() && outcome.faults++ == 0)
                outcome.what = text("call ", fault.first, " of ", calls, ", ", vulkan_.failed(), ": ", wrong);
        }
        run_.expect(configuration_, outcome);
    }

    // Checks that without faults hits are right and nothing is left alive.
    void end() {
        const CheckResult checked =
            check(world_.reference, rays_, session_.hits(world_, rays_), configuration_.backend);
        run_.add_checked(configuration_, checked, {.params = {{"failing", "nothing"}}});
        session_.end();
        const std::string left = what_is_left();
        run_.expect(configuration_, {.params = {{"failing", "nothing"}, {"asked", "what is left alive"}},
                                     .faults = left.empty() ? 0u : 1u,
                                     .what = left,
                                     .fault_of = "twinray"});
    }

  private:
    // Makes the state at the beginning of the part.
    void prepare(FailingPart part) {
        if (part == FailingPart::trace) return static_cast<void>(session_.hits(world_, rays_));
        session_.end();
    }

    std::vector<Hit> act(FailingPart part) {
        if (part != FailingPart::context) return session_.hits(world_, rays_);
        session_.make_context();
        return {};
    }

    std::uint64_t count_calls(FailingPart part, const Fault& fault) {
        prepare(part);
        vulkan_.inject({.first = faults::every_call, .result = fault.result});
        act(part);
        vulkan_.heal();
        return vulkan_.calls();
    }

    std::string what_is_wrong_with(FailingPart part, const Fault& fault) {
        prepare(part);
        std::vector<Hit> hits;
        std::string said, again;
        vulkan_.inject(fault);
        const faults::Outcome outcome = faults::outcome_of([&] { hits = act(part); }, &said);
        vulkan_.heal();
        if (outcome == faults::Outcome::done) {
            if (vulkan_.injected() && !faults::may_be_harmless(vulkan_.failed())) return "no error";
            return what_is_wrong_with(hits);
        }
        if (said.empty()) return "an error without a word";
        // After a loss, only another device can go on.
        if (fault.result == VK_ERROR_DEVICE_LOST) session_.end();
        if (fault.result == VK_ERROR_DEVICE_LOST || part == FailingPart::context)
            if (const std::string left = what_is_left(); !left.empty()) return left;
        if (faults::outcome_of([&] { hits = act(part); }, &again) != faults::Outcome::done) return "after it: " + again;
        return what_is_wrong_with(hits);
    }

    std::string what_is_wrong_with(const std::vector<Hit>& hits) const {
        if (hits.empty()) return "";  // a context alone
        return check(world_.reference, rays_, hits, configuration_.backend).faults ? "wrong hits" : "";
    }

    std::string what_is_left() const {
        for (const auto& [type, count] : vulkan_.live()) return text(count, " of ", type, " left alive");
        const std::size_t wrong = vulkan_.wrong_destructions();
        return wrong ? text(wrong, " objects destroyed that were not alive, or after their device") : "";
    }

    CaseRun& run_;
    Configuration configuration_;
    World world_ = world_of(make_box(vec3(0), vec3(1)));
    std::vector<Ray> rays_ = random_rays({vec3(-1), vec3(2)}, 64, run_.seed());
    FaultInjector vulkan_;
    Session session_;
};

}  // namespace

// Sessions take time to compile their kernels. Whole ones fail only in the full suite. Outside it, a device is lost
// only once, that of the last configuration.
void failing_calls(CaseRun& run) {
    const std::vector<Configuration> configurations = run.one_configuration_each();
    for (const Configuration& configuration : configurations) {
        const bool is_last = configuration == configurations.back();
        FailingRuns runs(run, configuration);
        runs.fail(FailingPart::context, {}, run.amount(3, 4'096));
        runs.fail(FailingPart::session, {}, run.is_whole() ? 4'096 : 0);
        runs.fail(FailingPart::trace, {}, run.amount(4, 4'096));
        runs.fail(FailingPart::trace, {.count = faults::every_call, .result = VK_ERROR_DEVICE_LOST},
                  run.is_whole() ? 256
                  : is_last      ? 1
                                 : 0);
        runs.end();
    }
}

}  // namespace twinray::suite
