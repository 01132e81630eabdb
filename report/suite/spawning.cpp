// SPDX-License-Identifier: MIT
#include "report/suite/spawning.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <twinray/geometry.h>
#include "engine/core/uploaded.h"
#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "suite_spawn.spv.h"

namespace twinray::suite {
namespace {

Values prices_of(std::span<const SpawnPrice> prices) {
    std::vector<double> shares;
    for (const SpawnPrice& price : prices) shares.push_back(double{price.offset} / double{price.feature});
    std::sort(shares.begin(), shares.end());
    return {{"offset_per_feature_median", quantile(shares, 0.5)}, {"offset_per_feature_max", shares.back()}};
}

// The outcome of the rays of each method.
struct Tally {
    std::map<SpawnOutcome, std::uint64_t> outcomes = {};
    std::string example = {};  // the first fault
    bool is_exact = false;     // of SPAWN_BOUND: the reference also shows one of the faults

    std::uint64_t count(SpawnOutcome outcome) const {
        const auto found = outcomes.find(outcome);
        return found == outcomes.end() ? 0 : found->second;
    }
    std::uint64_t faults() const { return count(SpawnOutcome::false_hit) + count(SpawnOutcome::leak); }
};
using Tallies = std::array<Tally, SPAWN_METHODS>;

Hit hit_of(const ReferenceHit& reference) {
    Hit hit{};
    hit.hit = reference.hit;
    hit.t = static_cast<float>(reference.t);
    hit.primitive_index = reference.primitive;
    return hit;
}

bool is_fault(SpawnOutcome outcome) { return outcome == SpawnOutcome::false_hit || outcome == SpawnOutcome::leak; }

Tallies tallies_of(const Departures& departures, const SpawnedRays& spawned, std::span<const Hit> hits,
                   const ReferenceScene& reference) {
    Tallies tallies;
    const std::size_t count = departures.items.size();
    for (std::size_t ray = 0; ray < hits.size(); ++ray) {
        Tally& tally = tallies[ray / count];
        const SpawnPrice& price = spawned.prices[ray % count];
        const SpawnOutcome outcome = departures.outcome_of(ray % count, hits[ray], price);
        ++tally.outcomes[outcome];
        if (!is_fault(outcome)) continue;
        if (ray / count == SPAWN_BOUND && !tally.is_exact) {
            const Hit exact = hit_of(reference.closest_hit(spawned.rays[ray]));
            tally.is_exact = is_fault(departures.outcome_of(ray % count, exact, price));
        }
        if (tally.example.empty())
            tally.example = (outcome == SpawnOutcome::leak ? "leak " : "false hit ") + hexadecimal(spawned.rays[ray]);
    }
    return tallies;
}

void set_tallies(Record& record, const Tallies& tallies) {
    const Tally& bound = tallies[SPAWN_BOUND];
    record.reference = "analytic";
    set_faults(record, bound.faults(), record.n);
    record.example = bound.example;
    record.results.emplace("flagged", bound.count(SpawnOutcome::flagged));
    // These methods report no offset, so that none of their faults is flagged.
    const auto faults = [&](uint method) {
        return tallies[method].faults() + tallies[method].count(SpawnOutcome::flagged);
    };
    record.results.emplace("faults_no_offset", faults(SPAWN_NONE));
    record.results.emplace("faults_t_min_1e-4", faults(SPAWN_T_MIN));
    record.results.emplace("faults_integer_offset", faults(SPAWN_INTEGER));
}

// Faults of hardware are the driver's if the rays are right by the reference.
void decide(Record& record, const Departures& departures, const Tallies& tallies, Backend backend) {
    const Tally& without_offset = tallies[SPAWN_NONE];
    const bool sees_nothing = departures.must_show && is_ours(backend) && without_offset.faults() == 0;
    record.pass = record.faults == 0 && !sees_nothing;
    if (sees_nothing) record.reason = "without an offset there are no faults either: the case sees nothing";
    if (*record.pass) return;
    const bool is_drivers = !is_ours(backend) && (departures.fault_of.empty() || !tallies[SPAWN_BOUND].is_exact);
    record.fault_of = is_drivers ? "driver" : "twinray";
}

// Returns a ray away from the triangle on the side of its normal; every second one grazes, at a cosine of 1 to 10^-4.
SpawnItem leaving(Random& random, const Mesh& mesh, const glm::dmat3& normals) {
    SpawnItem item{};
    item.primitive = random.below(mesh.triangles.size());
    item.uv = random.in_triangle();
    const uvec3 vertices = mesh.triangles[item.primitive];
    const dvec3 a(mesh.positions[vertices.x]), b(mesh.positions[vertices.y]), c(mesh.positions[vertices.z]);
    const dvec3 normal = normalize(normals * normalize(cross(b - a, c - a)));
    const dvec3 any(random.direction());
    const dvec3 along = normalize(any - dot(any, normal) * normal);
    const double cosine = random.below(2) ? std::abs(dot(any, normal)) : std::pow(10, -random.between(0, 4));
    item.direction = vec3(std::max(cosine, 1e-4) * normal + std::sqrt(1 - cosine * cosine) * along);
    return item;
}

std::vector<SpawnItem> leaving(Random& random, const Mesh& mesh, const Transform& transform, std::size_t count) {
    const glm::dmat3 normals = normals_of(transform);
    std::vector<SpawnItem> items(count);
    for (SpawnItem& item : items) item = leaving(random, mesh, normals);
    return items;
}

SpawnOutcome meets_itself(const SpawnItem& item, const Hit& hit) {
    return hit.hit && hit.primitive_index == item.primitive ? SpawnOutcome::false_hit : SpawnOutcome::right;
}

// Measures departures whose rays may meet other triangles.
void measure_self_hits(CaseRun& run, const Spawner& spawner, Departures departures) {
    departures.outcome_of = [&](std::size_t i, const Hit& hit, const SpawnPrice&) {
        return meets_itself(departures.items[i], hit);
    };
    measure_departures(run, spawner, departures);
}

struct Kind {
    const char* name;
    float size = 1;
    vec3 centre = vec3(0);
    float aspect = 1;
    vec3 extent = vec3(1);  // of a triangle, by axis
    Transform transform = {};
};

// Makes 128 separate triangles within a few sizes of the centre.
Mesh triangles_of(Random& random, const Kind& kind) {
    Mesh mesh;
    for (uint i = 0; i < 128; ++i) {
        const vec3 a = random.in_box(4), to_b = random.in_box(1) * kind.extent;
        const vec3 to_c = to_b * random.between(0, 1) + random.in_box(1) * kind.extent * kind.aspect;
        for (const vec3& vertex : {a, a + to_b, a + to_c}) mesh.positions.push_back(kind.centre + vertex * kind.size);
        mesh.triangles.push_back(uvec3(3 * i) + uvec3(0, 1, 2));
    }
    return mesh;
}

Transform nearly_unturned() {
    Transform turn;
    turn.rows = {vec4(1, -1e-4f, 2e-5f, 0), vec4(1e-4f, 1, -3e-5f, 0), vec4(-2e-5f, 3e-5f, 1, 0)};
    return turn;
}

std::vector<Kind> kinds(Random& random) {
    const Transform turned = random.rotation();
    const Transform stretched = turned * Transform::scaling({1, 10, 100}) * random.rotation();
    return {
        {.name = "unit"},
        {.name = "object offset 1e3", .centre = vec3(1e3f)},
        {.name = "object offset 1e6", .centre = vec3(1e6f)},
        {.name = "rotated, translation 1e4", .transform = Transform::translation(vec3(1e4f)) * turned},
        {.name = "object offset 1e3 cancelled", .centre = vec3(1e3f), .transform = Transform::translation(vec3(-1e3f))},
        {.name = "instance scale 1e3", .transform = Transform::scaling(vec3(1e3f))},
        {.name = "instance scale 1e-3", .transform = Transform::scaling(vec3(1e-3f))},
        {.name = "slivers 1e-4", .aspect = 1e-4f},
        {.name = "size 1e-6", .size = 1e-6f},
        {.name = "size 1e6", .size = 1e6f},
        {.name = "size 2^-60", .size = 0x1p-60f},
        {.name = "size 2^60", .size = 0x1p60f},
        // Across x, the inverse has small entries, which are differences of large ones, times the large translation.
        {.name = "across x, rotated by 1e-4, translation 1e4",
         .extent = vec3(0, 1, 1),
         .transform = Transform::translation({0, 1e4f, 0}) * nearly_unturned()},
        {.name = "scales 1 : 10 : 100 between rotations, translation 1e3",
         .transform = Transform::translation(vec3(1e3f)) * stretched},
    };
}

}  // namespace

Spawner::Spawner(Context& context)
    : context_(context), kernel_(context, {.name = "suite_spawn", .spirv = suite_spawn_spirv}) {}

SpawnedRays Spawner::operator()(const Mesh& mesh, const Transform& instance, std::span<const SpawnItem> items) const {
    InstanceRecord record{};
    record.object_to_world = {instance.rows[0], instance.rows[1], instance.rows[2]};
    const Buffer item_buffer = uploaded(context_, "spawn items", items);
    const Buffer instances = uploaded(context_, "spawn instance", std::span<const InstanceRecord>(&record, 1));
    const Buffer positions = uploaded(context_, "spawn positions", std::span<const vec3>(mesh.positions));
    const Buffer indices = uploaded(context_, "spawn indices", std::span<const uvec3>(mesh.triangles));
    const std::size_t ray_count = SPAWN_METHODS * items.size();
    const Buffer rays(context_, {.name = "spawned rays", .bytes = ray_count * sizeof(Ray)});
    const Buffer prices(context_, {.name = "spawn prices", .bytes = items.size() * sizeof(SpawnPrice)});
    Commands commands(context_, "spawn");
    const SpawnArgs args{.items = item_buffer.ref<SpawnItem>(),
                         .instances = instances.ref<InstanceRecord>(),
                         .positions = positions.ref<float>(),
                         .indices = indices.ref<uint>(),
                         .rays = rays.ref<Ray>(),
                         .prices = prices.ref<SpawnPrice>(),
                         .count = static_cast<uint>(items.size()),
                         .reserved = 0};
    kernel_.dispatch(commands, args, items.size());
    commands.submit();
    return {download<Ray>(context_, rays, ray_count), download<SpawnPrice>(context_, prices, items.size())};
}

glm::dmat3 linear_of(const Transform& transform) {
    const auto& rows = transform.rows;
    return transpose(glm::dmat3(dvec3(rows[0]), dvec3(rows[1]), dvec3(rows[2])));
}
glm::dmat3 normals_of(const Transform& transform) { return transpose(inverse(linear_of(transform))); }

void measure_departures(CaseRun& run, const Spawner& spawner, const Departures& departures) {
    const std::vector<Configuration> configurations = run.one_configuration_each();
    if (configurations.empty()) return;
    const SpawnedRays spawned = spawner(departures.mesh, departures.transform, departures.items);
    const World world = world_of(departures.mesh, departures.transform);
    for (const Traced& traced : trace(run.devices(), configurations, world, {.rays = spawned.rays, .reps = 0})) {
        const Tallies tallies = tallies_of(departures, spawned, traced.hits, world.reference);
        Record record = run.record(traced.configuration);
        record.params = departures.params;
        record.n = departures.items.size();
        record.results = prices_of(spawned.prices);
        set_tallies(record, tallies);
        decide(record, departures, tallies, traced.configuration.backend);
        run.add(record);
    }
}

// The body is convex: a ray that leaves it can only meet its own surface.
void leave_a_sphere(CaseRun& run) {
    const Spawner spawner(run.devices().context(Backend::software));
    Random random(run.seed());
    Departures departures{.mesh = make_icosphere(5)};
    departures.items = leaving(random, departures.mesh, {}, run.amount(8'192, 1'000'000));
    departures.outcome_of = [](std::size_t, const Hit& hit, const SpawnPrice&) {
        return hit.hit ? SpawnOutcome::false_hit : SpawnOutcome::right;
    };
    measure_departures(run, spawner, departures);
}

void leave_triangles_of_all_kinds(CaseRun& run) {
    const Spawner spawner(run.devices().context(Backend::software));
    Random random(run.seed());
    for (const Kind& kind : kinds(random)) {
        Departures departures{
            .mesh = triangles_of(random, kind), .transform = kind.transform, .params = {{"setting", kind.name}}};
        departures.items = leaving(random, departures.mesh, kind.transform, run.amount(1'024, 262'144));
        measure_self_hits(run, spawner, std::move(departures));
    }
}

void leave_cancelled_offsets(CaseRun& run) {
    const Spawner spawner(run.devices().context(Backend::software));
    Random random(run.seed());
    for (const float distance : {1e3f, 1e4f, 1e5f}) {
        Departures departures{.mesh = moved(make_icosphere(3), vec3(distance)), .params = {{"offset", distance}}};
        departures.transform = random.rotation() * Transform::translation(vec3(-distance));
        departures.items = leaving(random, departures.mesh, departures.transform, run.amount(2'048, 262'144));
        measure_self_hits(run, spawner, std::move(departures));
    }
}

}  // namespace twinray::suite
