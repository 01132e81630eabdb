#include "validation/leaks/leak_test.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "crossings_hw.spv.h"
#include "crossings_refined_hw.spv.h"
#include "crossings_refined_sw.spv.h"
#include "crossings_sw.spv.h"
#include "engine/accel/trace_desc.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/fnv1a.h"
#include "engine/core/json_input.h"
#include "engine/core/parallel.h"
#include "engine/core/statistics.h"
#include "engine/core/stopwatch.h"
#include "engine/core/commands.h"
#include "validation/leaks/closed_mesh.h"

namespace twinray {
namespace {

std::span<const std::uint32_t> spirv_of(bool is_software, Level level) {
    if (is_software) {
        if (level >= Level::refined) return crossings_refined_sw_spirv;
        return crossings_sw_spirv;
    }
    if (level >= Level::refined) return crossings_refined_hw_spirv;
    return crossings_hw_spirv;
}

}  // namespace

double LeakCounts::bound_95() const { return upper_bound_95(faults(), rays); }

struct LeakTest::State {
    State(AbstractAccel& traced, const Mesh& mesh, Level level, std::uint64_t seed)
        : accel(traced),
          closed(mesh),
          inside(closed, Aim::both, seed),
          counter(accel.context(), accel.is_software(), level) {
        accel.push(mesh, {}, {.non_opaque = true});
        accel.sync();
    }

    AbstractAccel& accel;
    ClosedMesh closed;
    InsideRays inside;
    CrossingCounter counter;
};

LeakTest::LeakTest(AbstractAccel& accel, const Mesh& mesh, Level level, std::uint64_t seed) {
    check_level(accel, "LeakTest", level);
    accel.check_kernel_queries("LeakTest");
    state_ = std::make_unique<State>(accel, mesh, level, seed);
}

LeakTest::~LeakTest() = default;

void LeakTest::trace(std::size_t count, LeakCounts& counts,
                     const std::function<void(const LeakFault&)>& on_fault) const {
    const std::vector<Ray> rays = state_->inside.rays(counts.rays, count);
    const std::vector<uint> crossings = state_->counter.count(state_->accel, rays);
    std::vector<Parity> parities(count);
    parallel_for(count, [&](std::size_t i) { parities[i] = check_crossings(state_->closed, rays[i], crossings[i]); });
    for (std::size_t i = 0; i < count; ++i) {
        const bool is_leak = parities[i] == Parity::leak, is_double_hit = parities[i] == Parity::double_hit;
        if ((is_leak || is_double_hit) && on_fault) on_fault({counts.rays + i, rays[i], crossings[i], is_leak});
        counts.leaks += is_leak;
        counts.double_hits += is_double_hit;
        counts.unspecified += parities[i] == Parity::unspecified;
    }
    counts.rays += count;
}

void trace_until(const LeakTest& test, std::uint64_t rays, LeakState& state,
                 const std::function<void(const LeakFault&)>& on_fault, const std::function<void(std::size_t)>& after) {
    constexpr std::uint64_t batch_size = 1 << 17;
    const Stopwatch begin;
    const double seconds_before = state.seconds;
    while (state.counts.rays < rays) {
        const auto count = static_cast<std::size_t>(std::min(batch_size, rays - state.counts.rays));
        test.trace(count, state.counts, on_fault);
        state.seconds = seconds_before + begin.seconds();
        after(count);
    }
}

std::uint64_t hash_of(const Mesh& mesh) {
    Fnv1a hash;  // over words
    for (const uvec3& triangle : mesh.triangles)
        for (int vertex = 0; vertex < 3; ++vertex)
            for (int axis = 0; axis < 3; ++axis)
                hash.add(std::bit_cast<std::uint32_t>(mesh.positions[triangle[vertex]][axis]));
    return hash.value();
}

LeakState read_state(const std::filesystem::path& file, const nlohmann::json& identity) {
    std::ifstream in(file);
    nlohmann::json state;
    try {
        state = parse_json<nlohmann::json>(in);
    } catch (const std::exception&) {
        state = {};
    }
    if (!state.is_object()) fail("'", file.string(), "' does not hold the state of a `twinray leaks`");
    for (const auto& [name, value] : identity.items())
        if (const nlohmann::json was = state.value(name, nlohmann::json()); was != value)
            fail("'", file.string(), "' belongs to another run: its ", name, " is ", was.dump(), ", not ",
                 value.dump());
    try {
        const auto count = [&](const char* name) { return unsigned_of<std::uint64_t>(state.at(name)); };
        return {{count("rays"), count("leaks"), count("double_hits"), count("unspecified")}, state.at("seconds")};
    } catch (const std::exception& error) {
        fail("'", file.string(), "': ", error.what());
    }
}

void write_state(const std::filesystem::path& file, nlohmann::json identity, const LeakState& state) {
    identity.update({{"rays", state.counts.rays},
                     {"leaks", state.counts.leaks},
                     {"double_hits", state.counts.double_hits},
                     {"unspecified", state.counts.unspecified},
                     {"seconds", state.seconds}});
    write_file(file, identity.dump(2) + '\n');
}

CrossingCounter::CrossingCounter(Context& context, bool is_software, Level level)
    : kernel_(context, {.name = "crossings",
                        .spirv = spirv_of(is_software, level),
                        .constants = {{FEATURES_CONSTANT, FEATURES_ALL & ~FEATURE_BOXES},
                                      {LEVEL_CONSTANT, static_cast<std::uint32_t>(level)}}}) {}

std::vector<uint> CrossingCounter::count(const AbstractAccel& accel, std::span<const Ray> rays) const {
    Context& context = accel.context();
    const Buffer from = uploaded(context, "crossings rays", rays);
    const Buffer counts(context, {.name = "crossings counts", .bytes = rays.size() * sizeof(uint)});
    Commands commands(context, "crossings");
    kernel_.dispatch(commands,
                     {.scene = accel.view().scene,
                      .rays = from.ref<Ray>(),
                      .counts = counts.ref<uint>(),
                      .count = static_cast<uint>(rays.size())},
                     rays.size());
    commands.submit();
    return download<uint>(context, counts, rays.size());
}

}  // namespace twinray
