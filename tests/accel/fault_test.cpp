// Each call into Vulkan that can fail is made to fail once, for every accelerator: an Error comes out, nothing is left
// half-changed, nothing leaks, and the same work succeeds afterwards. The validation layer is on and below the faults:
// it sees a failed call as one never made, so whatever it says is our fault. One file, since all scenarios share the
// fixture.
#include <cstdio>

#include <twinray/queries.h>
#include "tests/accel/fault_world.h"
#include "tests/support/caller.h"

namespace twinray {
namespace {

using faults::Counts;
using faults::every_call;
using faults::Fault;
using faults::FaultInjector;
using faults::may_be_harmless;
using faults::Outcome;
using faults::outcome_of;
using test::Kind;

class Faults : public ::testing::TestWithParam<Kind> {
  protected:
    ContextDesc desc() const {
        return test::desc_of(GetParam(),
                             {.validation = test::has_validation(), .get_instance_proc_addr = faults_.entry()});
    }
    ContextDesc unvalidated() const {
        ContextDesc quick = desc();
        quick.validation = false;
        return quick;
    }
    void SetUp() override {
        const std::unique_ptr<Context> context = test::make_context(desc());
        if (!context || GetParam() == Kind::software || missing_for_hardware(context->properties()).empty()) return;
        TWINRAY_LACKS("ray_tracing", context->properties().name + " has no such ray tracing");
    }
    static void TearDownTestSuite() {
        for (const auto& [accelerator, points] : points_)
            std::printf("%s: %zu calls failed on purpose\n", accelerator.c_str(), points);
    }
    FaultInjector& faults() { return faults_; }
    void count_point() { ++points_[test::name_of_kind({GetParam(), 0})]; }

    World world() { return World(faults_, GetParam(), desc()); }
    // Fails every call of `act` in turn, each in a world that `next` returns ready for it.
    void fail_every_call(const std::function<World&()>& next, const std::function<void(World&)>& act);
    // Does the same in one world whose base is synced; `prepare` makes it ready.
    void fail_in_one_world(const std::function<void(World&)>& prepare, const std::function<void(World&)>& act);
    // Fails every call of `make`, which makes nothing that lives on.
    void fail_every_call_of(const std::function<void()>& make);
    void check_after_fault(World& world, const World::State& before, Outcome outcome,
                           const std::function<void(World&)>& act);
    void check_that_it_stays_lost(World& world);
    void check_end(World& world);

  private:
    FaultInjector faults_;
    inline static Counts points_;  // by accelerator
};

INSTANTIATE_TEST_SUITE_P(Every, Faults, testing::Values(Kind::software, Kind::ray_query), test::name_of_kind);
INSTANTIATE_TEST_SUITE_P(Full, Faults, testing::Values(Kind::pipeline), test::name_of_kind);

void Faults::check_end(World& world) {
    world.destroy();
    EXPECT_EQ(faults_.live(), Counts{}) << "leaked";
    EXPECT_EQ(faults_.wrong_destructions(), 0u);
    for (const std::string& message : world.messages()) ADD_FAILURE() << message;
}

void Faults::fail_every_call(const std::function<World&()>& next, const std::function<void(World&)>& act) {
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        World& world = next();
        const World::State before = world.state();
        faults_.inject({.first = n});
        std::string what;
        const Outcome outcome = outcome_of([&] { act(world); }, &what);
        faults_.heal();
        if (!faults_.injected()) {
            ASSERT_EQ(outcome, Outcome::done) << what;
            ASSERT_GT(n, 1u) << "nothing was called";
            return;
        }
        count_point();
        SCOPED_TRACE(text("call ", n, ", ", faults_.failed(), ": ", what));
        EXPECT_EQ(what.find("unexpected"), std::string::npos) << "the error has no name";
        EXPECT_TRUE(outcome == Outcome::error || may_be_harmless(faults_.failed())) << "swallowed";
        check_after_fault(world, before, outcome, act);
    }
}

void Faults::fail_in_one_world(const std::function<void(World&)>& prepare, const std::function<void(World&)>& act) {
    World one = world();
    one.push_base();
    one.sync();
    const auto next = [&]() -> World& {
        prepare(one);
        return one;
    };
    fail_every_call(next, act);
    check_end(one);
}

void Faults::fail_every_call_of(const std::function<void()>& make) {
    const Counts before = faults_.live();
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        faults_.inject({.first = n});
        std::string what;
        const Outcome outcome = outcome_of(make, &what);
        faults_.heal();
        SCOPED_TRACE(text("call ", n, ", ", faults_.failed(), ": ", what));
        EXPECT_EQ(faults_.live(), before);
        const bool is_harmless = !faults_.injected() || may_be_harmless(faults_.failed());
        EXPECT_EQ(outcome, is_harmless ? Outcome::done : Outcome::error);
        if (!faults_.injected()) return;
        count_point();
    }
}

void Faults::check_after_fault(World& world, const World::State& before, Outcome outcome,
                               const std::function<void(World&)>& act) {
    if (outcome != Outcome::done) {
        const World::State after = world.state();
        EXPECT_EQ(after.live, before.live);
        EXPECT_TRUE(after == before) << "half-changed";
        world.check_view_of_last_sync();
        act(world);
    }
    world.check_hits();
}

void Faults::check_that_it_stays_lost(World& world) {
    Context& context = world.context();
    AbstractAccel& accel = world.accel();
    const std::size_t n_instances = accel.n_instances();
    EXPECT_EQ(accel.revision(), world.synced_revision());
    const std::pair<const char*, std::function<void()>> uses[] = {
        {"wait_for_gpu", [&] { accel.wait_for_gpu(); }},
        {"wait", [&] { context.wait(context.last_submission()); }},
        {"is_reached", [&] { (void)context.is_reached(context.last_submission()); }},
        {"closest_hits", [&] { accel.closest_hits(world_rays); }},
        {"any_hits", [&] { accel.any_hits(world_rays); }},
        {"sync", [&] { accel.push(make_box(vec3(0), vec3(1))), accel.sync(); }},
        {"commands", [&] { const Commands commands(context, "after the loss"); }},
        {"submit", [&] { context.state().submit("nothing", {}); }},
        {"build_timings", [&] { accel.revision() ? (void)accel.build_timings() : context.state().check_alive(); }},
    };
    for (const auto& [name, use] : uses) EXPECT_EQ(outcome_of(use), Outcome::lost) << name;
    EXPECT_EQ(accel.n_instances(), n_instances + 1) << "edits need no device";
    EXPECT_EQ(accel.revision(), world.synced_revision());
}

TEST_P(Faults, CreatingAContext) {
    EXPECT_TRUE(faults().live().empty());
    fail_every_call_of([&] { const Context context(desc()); });
    EXPECT_EQ(faults().wrong_destructions(), 0u);
}

TEST_P(Faults, CreatingTheAccelerator) {
    World around = world();
    Context& context = around.context();
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        context.wait_for_gpu();
        const Counts before = faults().live_objects();
        const std::uint64_t bytes = context.allocated_bytes();
        faults().inject({.first = n});
        std::string what;
        const Outcome outcome = outcome_of([&] { make_accel(context, GetParam()); }, &what);
        faults().heal();
        SCOPED_TRACE(text("call ", n, ", ", faults().failed(), ": ", what));
        context.wait_for_gpu();
        EXPECT_EQ(context.allocated_bytes(), bytes);
        EXPECT_EQ(faults().live_objects(), before);
        if (!faults().injected()) {
            EXPECT_EQ(outcome, Outcome::done) << what;
            break;
        }
        count_point();
        EXPECT_EQ(outcome, may_be_harmless(faults().failed()) ? Outcome::done : Outcome::error);
    }
    around.push_base();
    around.check_hits();
    check_end(around);
}

// The accelerator lends a copy of its meshes, which a failure may leave without its contents. One collider is used
// throughout, and ids of vertices come and go.
TEST_P(Faults, ContactsOfItsMeshes) {
    World around = world();
    const Mesh box = make_box(vec3(0), vec3(1));
    around.accel().push(box, std::vector{Transform{}, Transform::translation({0.5f, 0.25f, 0.125f})});
    auto collider = std::make_unique<NarrowPhase>(around.context());
    const auto contacts_by = [&](SharedVertices shared) {
        std::vector<std::pair<uint, uint>> pairs;
        for (const TriangleContact& contact : collider->find(around.accel(), {.shared = shared}).list)
            pairs.emplace_back(contact.triangle_a, contact.triangle_b);
        return pairs;
    };
    const auto expected = contacts_by(SharedVertices::by_index);
    EXPECT_FALSE(expected.empty());
    for (std::uint64_t n = 1; !HasFailure(); ++n) {
        faults().inject({.first = n});
        std::string what;
        outcome_of([&] { contacts_by(SharedVertices::by_position); }, &what);
        faults().heal();
        if (!faults().injected()) break;
        count_point();
        SCOPED_TRACE(text("call ", n, ", ", faults().failed(), ": ", what));
        EXPECT_EQ(contacts_by(SharedVertices::by_index), expected);
    }
    collider.reset();
    check_end(around);
}

// In a context of its own each time, so that the allocator has nothing yet; without the validation layer, to be quick.
TEST_P(Faults, TheFirstSync) {
    std::unique_ptr<World> fresh;
    const auto next = [&]() -> World& {
        if (fresh) check_end(*fresh);
        fresh = std::make_unique<World>(faults(), GetParam(), unvalidated());
        fresh->push_base();
        return *fresh;
    };
    fail_every_call(next, &World::sync);
    check_end(*fresh);
}

TEST_P(Faults, TheSyncOfAnEdit) { fail_in_one_world(&World::edit, &World::sync); }

// Only transforms change: the first sync rebuilds, later ones refit in place.
TEST_P(Faults, TheSyncOfAMove) { fail_in_one_world(&World::move, &World::sync); }

// The first sync builds what can be refitted, later ones refit in place.
TEST_P(Faults, TheSyncOfMovedVertices) {
    World deformed = world();
    deformed.push_base();
    for (const Memory where : {Memory::upload, Memory::device})
        for (const bool is_first : {true, false}) {
            const auto next = [&]() -> World& {
                if (is_first) deformed.renew_tower();
                deformed.sync();
                deformed.deform(where);
                return deformed;
            };
            fail_every_call(next, &World::sync);
        }
    check_end(deformed);
}

// The driver asks for more memory than it needs.
TEST_P(Faults, TheSyncThatCompacts) {
    faults().set_structure_slack(GetParam() == Kind::software ? 0 : 4097);
    World compacted = world();
    compacted.push_base();
    bool was_compacted = false;
    const auto next = [&]() -> World& {
        compacted.renew_tower();
        compacted.sync();
        compacted.context().wait_for_gpu();
        was_compacted = compacted.accel().compact();
        compacted.move();
        return compacted;
    };
    fail_every_call(next, &World::sync);
    EXPECT_EQ(was_compacted, GetParam() != Kind::software);
    check_end(compacted);
}

TEST_P(Faults, Pushing) {
    fail_in_one_world([](World&) {}, &World::push_aside);
}

// Commands into which the sync could not be recorded are given up: the host reaches their value without them.
TEST_P(Faults, TheSyncIntoTheHostsCommands) {
    World edited = world();
    edited.push_base();
    edited.sync();
    auto host = std::make_unique<test::Caller>(edited.context());
    bool is_over = false;
    for (std::uint64_t n = 1; !is_over && !HasFailure(); ++n) {
        edited.edit();
        const World::State before = edited.state();
        const CallerCommands commands = host->begin();
        faults().inject({.first = n});
        const Outcome outcome = outcome_of([&] {
            Commands recorded(edited.context(), "for the host", commands);
            edited.accel().sync(recorded);
        });
        faults().heal();
        is_over = !faults().injected();
        if (!is_over) count_point();
        SCOPED_TRACE(text("call ", n, ", ", faults().failed()));
        EXPECT_TRUE(outcome == (is_over ? Outcome::done : Outcome::error) || may_be_harmless(faults().failed()));
        CallerCommands submitted = outcome == Outcome::done ? commands : host->begin();
        submitted.done = commands.done;
        host->submit(submitted);
        check_after_fault(edited, before, outcome, &World::sync);
    }
    host.reset();
    check_end(edited);
}

TEST_P(Faults, TracingForTheHost) {
    fail_in_one_world([](World&) {}, &World::check_hits);
}

TEST_P(Faults, WaitingAndTimings) {
    const auto wait = [](World& w) {
        w.accel().wait_for_gpu();
        EXPECT_TRUE(w.context().is_reached(w.context().last_submission()));
        EXPECT_FALSE(w.accel().build_timings().empty());
    };
    fail_in_one_world([](World&) {}, wait);
}

void occupy_queue(Context& context) {
    constexpr std::uint64_t bytes = 64 << 20;
    const Buffer filled(context, {.name = "filled", .bytes = bytes});
    Commands commands(context, "fill");
    for (std::uint32_t word = 0; word < 10; ++word) {
        const auto pass = commands.pass("fill");
        commands.fill(filled, 0, bytes, word);
    }
    commands.submit();
}

// The failing wait is that of the context's destructor, which must neither throw nor free what the GPU works on.
TEST_P(Faults, EndingWhileTheGpuIsBusy) {
    for (const Fault& fault :
         {Fault{}, Fault{.function = "vkWaitSemaphores", .count = every_call}, Fault{.result = VK_ERROR_DEVICE_LOST}}) {
        World busy = world();
        busy.push_base();
        busy.sync();
        occupy_queue(busy.context());
        faults().inject(fault);
        EXPECT_EQ(outcome_of([&] { busy.destroy(); }), Outcome::done);
        faults().heal();
        EXPECT_EQ(faults().failed(), "vkWaitSemaphores");
        count_point();
        check_end(busy);
    }
}

// Returns buffers that take all memory that the allocator holds already, down to the last bytes.
std::vector<Buffer> fill_memory(Context& context) {
    std::vector<Buffer> buffers;
    for (std::uint64_t bytes = 64 << 20; bytes >= 16;)
        if (outcome_of([&] { buffers.emplace_back(context, BufferDesc{.name = "filler", .bytes = bytes}); }) !=
            Outcome::done)
            bytes /= 2;
    return buffers;
}

// Refuses all allocations from now on, not just one, which VMA works around.
TEST_P(Faults, OutOfMemory) {
    for (const char* function : {"vkAllocateMemory", "vkCreateBuffer"}) {
        SCOPED_TRACE(function);
        World full = world();
        full.push_base();
        faults().inject({.function = function, .count = every_call});
        {
            const std::vector<Buffer> fillers = fill_memory(full.context());
            const World::State before = full.state();
            std::string what;
            EXPECT_EQ(outcome_of([&] { full.sync(); }, &what), Outcome::error);
            EXPECT_NE(what.find("bytes: out of device memory"), std::string::npos) << what;
            faults().heal();
            check_after_fault(full, before, Outcome::error, &World::sync);
            count_point();
        }
        check_end(full);
    }
}

// With count 1 the driver forgets the loss, and the context must not. With every_call the device stays lost, as with
// real drivers; a sample suffices. The test runs without the validation layer, which knows nothing of the loss and
// takes half of the time.
TEST_P(Faults, LosingTheDevice) {
    const auto session = [](World& w) {
        w.push_base();
        w.sync();
        w.edit();
        w.sync();
        w.check_hits();
        EXPECT_FALSE(w.accel().build_timings().empty());
        w.accel().wait_for_gpu();
    };
    std::size_t told = 0;
    for (const std::uint64_t count : {std::uint64_t{1}, every_call})
        for (std::uint64_t n = 1; !HasFailure(); n += count == 1 ? 1 : 4) {
            World lost(faults(), GetParam(), unvalidated());
            faults().inject({.first = n, .count = count, .result = VK_ERROR_DEVICE_LOST});
            std::string what;
            const Outcome outcome = outcome_of([&] { session(lost); }, &what);
            if (!faults().injected()) break;
            count_point();
            if (what.find("; in flight: '") != std::string::npos) ++told;
            SCOPED_TRACE(text("call ", n, ", ", faults().failed()));
            EXPECT_TRUE(outcome == Outcome::lost || faults().failed() == "vkGetSemaphoreCounterValue");
            check_that_it_stays_lost(lost);
            faults().heal();
            check_end(lost);
        }
    EXPECT_GT(told, 0u) << "what was in flight";
}

TEST_P(Faults, AdoptingADevice) {
    Context host(desc());
    AdoptedDevice device;
    device.instance = faults().instance();
    device.physical_device = host.physical_device();
    device.device = host.device();
    device.queue_family = host.queue_family();
    host.state().vk().vkGetDeviceQueue(host.device(), host.queue_family(), 0, &device.queue);
    device.get_instance_proc_addr = faults().entry();
    device.api_version = VK_API_VERSION_1_2;
    device.enabled = host.properties();
    fail_every_call_of([&] { const Context context(device); });
}

}  // namespace
}  // namespace twinray
