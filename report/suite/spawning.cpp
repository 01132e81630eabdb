// Points of surfaces and rays that leave them: cases F01 to F03, F05 and I10.
#include "report/suite/sections.h"

#include "engine/core/kernel.h"
#include "engine/core/commands.h"
#include "suite_spawn.spv.h"
#include "twinray/glsl/cpp_spawn.h"

namespace twinray::suite {
namespace {

#include "twinray/glsl/cpp_begin.h"
#include "shaders/suite/spawn_args.h"
#include "twinray/glsl/cpp_end.h"

struct SpawnedRays {
    std::vector<Ray> rays;           // of every method, one per item
    std::vector<SpawnPrice> prices;  // of the items by SPAWN_BOUND
};

// The outcome of a ray that left a surface.
enum class SpawnOutcome : std::uint8_t {
    right,
    false_hit,  // of its own triangle, or of nothing that lies there
    leak,       // past what it had to meet
    flagged,    // a leak past what lies within twice the point's offset, as the offset says
};

struct Departures {
    Mesh mesh = {};
    Transform transform = {};
    std::vector<SpawnItem> items = {};  // of instance 0
    Values params = {};
    std::function<SpawnOutcome(std::size_t item, const Hit& hit, const SpawnPrice& price)> outcome_of = {};
    // Negative control: without an offset, software must show faults; otherwise the case sees nothing.
    bool must_show = true;
    std::string fault_of = "twinray";  // "" = by the backend
};

// A kernel that lets rays leave points of a mesh, by the function that users call. It is compiled once, and the rays
// are the same for all accelerators, because it traces nothing.
class Spawner {
  public:
    explicit Spawner(CaseRun& run)
        : context_(run.devices().context(Backend::software)),
          kernel_(context_, {.name = "suite_spawn", .spirv = suite_spawn_spirv}) {}

    SpawnedRays operator()(const Mesh& mesh, const Transform& instance, std::span<const SpawnItem> items) const {
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

  private:
    Context& context_;
    Kernel<SpawnArgs> kernel_;
};

Values prices_of(std::span<const SpawnPrice> prices) {
    std::vector<double> shares;
    for (const SpawnPrice& price : prices) shares.push_back(double{price.offset} / double{price.feature});
    std::sort(shares.begin(), shares.end());
    return {{"offset_per_feature_median", quantile(shares, 0.5)}, {"offset_per_feature_max", shares.back()}};
}

// The outcome of the rays of each method.
struct Tally {
    std::uint64_t faults = 0, flagged = 0;
    std::string example = {};  // the first fault
    bool is_exact = false;     // of SPAWN_BOUND: the reference also shows one of the faults
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
        tally.flagged += outcome == SpawnOutcome::flagged;
        if (!is_fault(outcome)) continue;
        ++tally.faults;
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
    set_faults(record, bound.faults, record.n);
    record.example = bound.example;
    record.results.emplace("flagged", bound.flagged);
    // These methods report no offset, so that none of their faults is flagged.
    for (const auto& [name, method] : {std::pair{"faults_no_offset", SPAWN_NONE},
                                       {"faults_t_min_1e-4", SPAWN_T_MIN},
                                       {"faults_integer_offset", SPAWN_INTEGER}})
        record.results.emplace(name, tallies[method].faults + tallies[method].flagged);
}

// Faults of hardware are the driver's if the rays are right by the reference.
void decide(Record& record, const Departures& departures, const Tallies& tallies, Backend backend) {
    const bool sees_nothing = departures.must_show && is_ours(backend) && tallies[SPAWN_NONE].faults == 0;
    record.pass = record.faults == 0 && !sees_nothing;
    if (sees_nothing) record.reason = "without an offset there are no faults either: the case sees nothing";
    if (*record.pass) return;
    const bool is_drivers = !is_ours(backend) && (departures.fault_of.empty() || !tallies[SPAWN_BOUND].is_exact);
    record.fault_of = is_drivers ? "driver" : "twinray";
}

// Spawns every item by every method, traces the closest hits on each backend and records the outcomes. The public
// function must have no faults; those of the other methods are results.
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

// Returns a ray away from the triangle on the side of its normal; every second one grazes, at a cosine of 1 to 10^-4.
SpawnItem leaving(Random& random, const Mesh& mesh, const glm::dmat3& normals) {
    SpawnItem item{};
    item.primitive = random.below(mesh.triangles.size());
    item.uv = random.in_triangle();
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[item.primitive]);
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

// Measures departures whose rays may meet other triangles.
void measure_self_hits(CaseRun& run, const Spawner& spawner, Departures departures) {
    departures.outcome_of = [&](std::size_t i, const Hit& hit, const SpawnPrice&) {
        const bool meets_itself = hit.hit && hit.primitive_index == departures.items[i].primitive;
        return meets_itself ? SpawnOutcome::false_hit : SpawnOutcome::right;
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

// ---- Rays that leave a surface close to another one, which they must meet, or must not.

// Joins two quads: triangles 0 and 1, and 2 and 3.
Mesh two_quads(Mesh both, const Mesh& second) {
    append(both, second);
    return both;
}
bool is_second_quad(const Hit& hit) { return hit.hit && hit.primitive_index >= 2; }

// Returns the point (x, y) of make_quad(0, (1, 0, 0), (0, 1, 0)).
SpawnItem at(float x, float y) {
    SpawnItem item{};
    item.primitive = y < x ? 0 : 1;
    item.uv = y < x ? vec2(x - y, y) : vec2(x, y - x);
    return item;
}

// Returns a rigid transform that rounds all components of coordinates.
Transform somewhere(Random& random) { return Transform::translation(random.in_box(1)) * random.rotation(); }

// Points at x from the corner, between a floor along x and a wall at `dihedral` to it, both 1 long. A ray either ends
// on the wall or leads away from it.
struct Corner {
    Departures departures;
    std::vector<bool> ends_on_wall;
    std::vector<double> distance;  // how far the ray can move before what it meets changes
};

// Returns the distance of the line through p along `way` from the line through `corner` along `edge`.
double distance_of_lines(const dvec3& p, const dvec3& way, const dvec3& corner, const dvec3& edge) {
    const dvec3 across = cross(way, edge);
    return std::abs(dot(corner - p, normalize(across)));
}

// Returns the distance of a ray that ends on the wall from the wall's edges: little if the wall is nearly flat to the
// floor.
double distance_from_edges(const dvec3& p, const dvec3& way, const dvec3& up_wall) {
    const dvec3 y(0, 1, 0);
    return std::min({distance_of_lines(p, way, dvec3(0), y), distance_of_lines(p, way, up_wall, y),
                     distance_of_lines(p, way, dvec3(0), up_wall), distance_of_lines(p, way, y, up_wall)});
}

Corner concave_corner(Random& random, double degrees, std::size_t count) {
    const double dihedral = glm::radians(degrees);
    const dvec3 up_wall(std::cos(dihedral), 0, std::sin(dihedral));
    Corner corner;
    Departures& departures = corner.departures;
    departures.mesh =
        two_quads(make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(up_wall)));
    departures.transform = somewhere(random);
    const glm::dmat3 linear = linear_of(departures.transform);
    for (std::size_t i = 0; i < count; ++i) {
        const float x = std::pow(10.0f, -random.between(0.05f, 4)), y = random.between(0.3f, 0.7f);
        SpawnItem item = at(x, y);
        const bool to_wall = random.below(2) != 0;
        const double up = std::min(0.9, x * std::pow(10.0, random.between(-1, 1)));
        const double angle = dihedral * random.between(0.02f, 0.98f);
        const dvec3 target = up * up_wall + dvec3(0, random.between(0.3f, 0.7f), 0);
        const dvec3 way =
            to_wall ? target - dvec3(x, y, 0) : dvec3(std::cos(angle), random.between(-0.3f, 0.3f), std::sin(angle));
        item.direction = vec3(linear * normalize(way));
        departures.items.push_back(item);
        corner.ends_on_wall.push_back(to_wall);
        const double from_wall = degrees < 90 ? x * std::sin(dihedral) : x;
        corner.distance.push_back(to_wall ? std::min(from_wall, distance_from_edges(dvec3(x, y, 0), way, up_wall))
                                          : from_wall);
    }
    return corner;
}

}  // namespace

// The body is convex: a ray that leaves it can only meet its own surface.
void leave_a_sphere(CaseRun& run) {
    const Spawner spawner(run);
    Random random(run.seed());
    Departures departures{.mesh = make_icosphere(5)};
    departures.items = leaving(random, departures.mesh, {}, run.amount(8'192, 1'000'000));
    departures.outcome_of = [](std::size_t, const Hit& hit, const SpawnPrice&) {
        return hit.hit ? SpawnOutcome::false_hit : SpawnOutcome::right;
    };
    measure_departures(run, spawner, departures);
}

void leave_triangles_of_all_kinds(CaseRun& run) {
    const Spawner spawner(run);
    Random random(run.seed());
    for (const Kind& kind : kinds(random)) {
        Departures departures{
            .mesh = triangles_of(random, kind), .transform = kind.transform, .params = {{"setting", kind.name}}};
        departures.items = leaving(random, departures.mesh, kind.transform, run.amount(1'024, 262'144));
        measure_self_hits(run, spawner, std::move(departures));
    }
}

void leave_cancelled_offsets(CaseRun& run) {
    const Spawner spawner(run);
    Random random(run.seed());
    for (const float distance : {1e3f, 1e4f, 1e5f}) {
        Departures departures{.mesh = moved(make_icosphere(3), vec3(distance)), .params = {{"offset", distance}}};
        departures.transform = random.rotation() * Transform::translation(vec3(-distance));
        departures.items = leaving(random, departures.mesh, departures.transform, run.amount(2'048, 262'144));
        measure_self_hits(run, spawner, std::move(departures));
    }
}

// Rays leave the middle of a plate upwards, so steeply that all end on the plate above.
void leave_between_plates(CaseRun& run) {
    const Spawner spawner(run);
    Random random(run.seed());
    for (const float gap : {1e-3f, 1e-4f, 1e-5f, 1e-6f, 1e-7f}) {
        const vec3 x(1, 0, 0), y(0, 1, 0);
        Departures departures{.mesh = two_quads(make_quad(vec3(0), x, y), make_quad(vec3(0, 0, gap), x, y)),
                              .transform = somewhere(random),
                              .params = {{"gap", gap}},
                              .must_show = false,
                              .fault_of = ""};
        const glm::dmat3 linear = linear_of(departures.transform);
        for (std::size_t i = 0; i < run.amount(1'024, 262'144); ++i) {
            departures.items.push_back(at(random.between(0.2f, 0.8f), random.between(0.2f, 0.8f)));
            const vec3 direction = random.direction();
            departures.items.back().direction =
                vec3(linear * normalize(dvec3(direction.x, direction.y, std::max(std::abs(direction.z), 0.1f))));
        }
        departures.outcome_of = [gap](std::size_t, const Hit& hit, const SpawnPrice& price) {
            if (is_second_quad(hit)) return SpawnOutcome::right;
            if (hit.hit) return SpawnOutcome::false_hit;
            return 2 * price.offset < gap ? SpawnOutcome::leak : SpawnOutcome::flagged;
        };
        measure_departures(run, spawner, departures);
    }
}

void leave_a_concave_corner(CaseRun& run) {
    const Spawner spawner(run);
    Random random(run.seed());
    for (const double degrees : {1.0, 5.0, 30.0, 90.0, 150.0, 175.0, 179.0}) {
        Corner corner = concave_corner(random, degrees, run.amount(1'024, 262'144));
        corner.departures.params = {{"dihedral", degrees}};
        corner.departures.fault_of = "";
        corner.departures.outcome_of = [&corner](std::size_t i, const Hit& hit, const SpawnPrice& price) {
            const bool is_flagged = corner.distance[i] < 2 * double{price.offset};
            if (corner.ends_on_wall[i]) {
                if (is_second_quad(hit)) return SpawnOutcome::right;
                return is_flagged ? SpawnOutcome::flagged : hit.hit ? SpawnOutcome::false_hit : SpawnOutcome::leak;
            }
            if (!hit.hit) return SpawnOutcome::right;
            return is_flagged && is_second_quad(hit) ? SpawnOutcome::flagged : SpawnOutcome::false_hit;
        };
        measure_departures(run, spawner, corner.departures);
    }
}

}  // namespace twinray::suite
