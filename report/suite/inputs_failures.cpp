// Vulkan that fails under the library, and input that is too large.
#include "report/suite/sections.h"

#include "engine/core/context.h"
#include "engine/core/vulkan.h"
#include "report/faults/fault_injection.h"

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
          options_(devices.options(configuration)) {
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

namespace {

// ---- More memory than a device has, and more than 32 bits can address.

constexpr std::uint64_t four_gib = std::uint64_t{1} << 32;

// The visible state of a context and an accelerator.
struct Seen {
    std::uint64_t allocated_bytes, revision;
    Hit hit;

    bool operator==(const Seen& other) const {
        return allocated_bytes == other.allocated_bytes && revision == other.revision && same_bits(hit, other.hit);
    }
};

Seen look_at(AbstractAccel& accel) {
    const Ray down{vec3(0.3f, 0.4f, 5), 0, vec3(0, 0, -1), inf};
    const Hit hit = accel.closest_hits(std::span(&down, 1)).front();
    accel.context().wait_for_gpu();
    return {accel.context().allocated_bytes(), accel.revision(), hit};
}

void refuse_what_no_device_has(CaseRun& run, const Configuration& configuration) {
    constexpr std::uint64_t bytes = std::uint64_t{1} << 44;
    AbstractAccel& accel = run.devices().empty_accel(configuration);
    accel.push(make_box(vec3(0), vec3(1)));
    const Seen before = look_at(accel);
    const std::string error =
        faults::what_is_thrown_by([&] { const Buffer buffer(accel.context(), {.name = "huge", .bytes = bytes}); });
    CaseRun::Outcome outcome{.params = {{"asked", "a buffer of 2^44 bytes"}}, .fault_of = "twinray"};
    if (error.find(std::to_string(bytes)) == std::string::npos)
        outcome.what = error.empty() ? "not refused" : "refused without its size: " + error;
    else if (!(look_at(accel) == before))
        outcome.what = "refused, but something has changed";
    outcome.faults = !outcome.what.empty();
    run.expect(configuration, outcome);
}

// Squares of two triangles in the plane z = 0, `side` along x and `side` - 1 along y, at whole numbers, so that
// nothing is rounded.
struct Plane {
    uint side;

    std::uint64_t vertices() const { return std::uint64_t{side + 1} * side; }
    std::uint64_t triangles() const { return std::uint64_t{2} * side * (side - 1); }
    Mesh mesh() const {
        Mesh mesh;
        mesh.name = "plane";
        mesh.positions.reserve(vertices());
        mesh.triangles.reserve(triangles());
        for (uint y = 0; y < side; ++y)
            for (uint x = 0; x <= side; ++x) mesh.positions.emplace_back(x, y, 0);
        for (uint y = 0; y + 1 < side; ++y)
            for (uint x = 0; x < side; ++x) {
                const uint at = y * (side + 1) + x, above = at + side + 1;
                mesh.triangles.emplace_back(at, at + 1, above);
                mesh.triangles.emplace_back(at + 1, above + 1, above);
            }
        return mesh;
    }
    // Returns a ray down from height 8 onto a triangle's inside.
    Ray onto(uint triangle) const {
        const uint square = triangle / 2;
        const float inside = triangle % 2 ? 0.75f : 0.25f;
        return {vec3(static_cast<float>(square % side) + inside, static_cast<float>(square / side) + inside, 8), 0,
                vec3(0, 0, -1), inf};
    }
};

std::uint64_t largest_heap(Context& context) {
    VkPhysicalDeviceMemoryProperties memory{};
    context.state().vk().vkGetPhysicalDeviceMemoryProperties(context.physical_device(), &memory);
    std::uint64_t largest = 0;
    for (uint i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            largest = std::max<std::uint64_t>(largest, memory.memoryHeaps[i].size);
    return largest;
}

struct Planes {
    Plane plane;
    std::size_t count;
    BuildBytes bytes;
};

// Returns as many as need more than `least` bytes of trees, at least two.
Planes planes_beyond(std::uint64_t least, const Plane& plane, const AbstractAccel& accel) {
    for (std::size_t count = 2;; ++count) {
        const std::vector<GeometrySize> sizes(count, {plane.vertices(), plane.triangles()});
        const BuildBytes bytes = accel.memory_requirements(sizes, count);
        if (bytes.structures > least) return {plane, count, bytes};
    }
}

// The first ray of each plane is aimed at its first triangle, the second at its last.
void expect_every_square(CaseRun& run, const Configuration& configuration, AbstractAccel& accel, const Planes& planes) {
    const Mesh mesh = planes.plane.mesh();
    const auto far = [&](std::size_t i) { return static_cast<float>(i * 2 * planes.plane.side); };
    for (std::size_t i = 0; i < planes.count; ++i) accel.push(mesh, Transform::translation(vec3(far(i), 0, 0)));
    Random random(run.seed());
    const auto triangles = static_cast<uint>(planes.plane.triangles());
    CaseRun::Outcome outcome{.params = {{"asked", "planes"}, {"side", planes.plane.side}},
                             .results = {{"planes", planes.count}, {"triangles", triangles}},
                             .n = 0,
                             .reference = "analytic"};
    for (std::size_t i = 0; i < planes.count; ++i) {
        std::vector<uint> targets = {0, triangles - 1};
        for (std::size_t n = run.is_whole() ? 100'000 : 512; n > 0; --n) targets.push_back(random.below(triangles));
        std::vector<Ray> rays;
        for (const uint target : targets) {
            rays.push_back(planes.plane.onto(target));
            rays.back().origin.x += far(i);
        }
        const std::vector<Hit> hits = accel.closest_hits(rays, {.level = configuration.level});
        for (std::size_t r = 0; r < rays.size(); ++r, ++outcome.n) {
            const bool is_right = hits[r].hit && hits[r].instance_index == i && hits[r].primitive_index == targets[r] &&
                                  std::abs(hits[r].t - 8) <= 0x1p-16f;
            if (!is_right && outcome.faults++ == 0)
                outcome.what = text("plane ", i, ", triangle ", targets[r], ": ", hits[r].hit ? "hit triangle " : "",
                                    hits[r].hit ? std::to_string(hits[r].primitive_index) : "missed");
        }
    }
    outcome.results.emplace("bytes_of_trees", accel.memory_usage().structures());
    run.expect(configuration, outcome);
}

}  // namespace

// In the full suite, a geometry has as many triangles as Plane can have below 2^25, and all trees take more than 4 GiB;
// half of the heap is left to other users.
void large_buffers(CaseRun& run) {
    const std::uint64_t least = run.is_whole() ? four_gib : 0;
    const Plane plane{run.is_whole() ? 4'096u : 16u};
    for (const Configuration& configuration : run.one_configuration_each()) {
        refuse_what_no_device_has(run, configuration);
        const std::unique_ptr<AbstractAccel> accel = run.devices().make_accel(configuration);
        const Planes planes = planes_beyond(least, plane, *accel);
        const std::uint64_t needed =
            planes.bytes.structures + planes.bytes.scratch +
            planes.count * (sizeof(vec3) * plane.vertices() + sizeof(uvec3) * plane.triangles());
        const std::uint64_t heap = largest_heap(run.devices().context(configuration.backend));
        if (needed <= heap / 2) {
            expect_every_square(run, configuration, *accel, planes);
            continue;
        }
        run.expect(configuration,
                   {.params = {{"asked", "planes"}, {"side", plane.side}},
                    .results = {{"planes", planes.count}, {"bytes_needed", needed}, {"heap_bytes", heap}},
                    .n = 0,
                    .only_measured =
                        text("nothing was traced: ", needed, " bytes do not fit half of the device's heap of ", heap)});
    }
}

}  // namespace twinray::suite
