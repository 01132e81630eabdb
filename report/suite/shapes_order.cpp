// Triangles in the same place, or nearly: which of them is hit.
#include "report/suite/sections.h"

#include <array>

namespace twinray::suite {
namespace {

const char* const driver_chooses = "of triangles at one t the driver chooses";

// `copies` of each triangle, in an order that does not follow places.
struct Copies {
    Mesh mesh;
    std::vector<uint> lowest;  // of each triangle: its first copy
};

Copies copies_of(const Mesh& mesh, std::size_t copies, std::uint64_t seed) {
    Copies result{mesh, {}};
    std::vector<uint> originals, first(mesh.triangles.size(), UINT32_MAX);
    for (std::size_t i = 0; i < copies * mesh.triangles.size(); ++i)
        originals.push_back(static_cast<uint>(i % mesh.triangles.size()));
    std::shuffle(originals.begin(), originals.end(), std::mt19937(static_cast<std::uint32_t>(seed)));
    result.mesh.triangles.clear();
    for (const uint original : originals) {
        first[original] = std::min(first[original], static_cast<uint>(result.mesh.triangles.size()));
        result.lowest.push_back(first[original]);
        result.mesh.triangles.push_back(mesh.triangles[original]);
    }
    return result;
}

void expect_lowest(CaseRun& run, const char* what, const Mesh& mesh, std::size_t copies, std::size_t rays_count) {
    const Copies scene = copies_of(mesh, copies, run.seed());
    const World world = world_of(scene.mesh);
    const std::vector<Ray> rays = random_rays(bounds_of(mesh), rays_count, run.seed());
    const Measured measured = run.measure(world, rays, {.params = {{"of", what}, {"copies", copies}}, .reps = 1});
    const std::vector<Traced> again = run.trace(world, rays);
    expect_each(run, measured.traces, rays,
                {.params = {{"of", what}, {"copies", copies}, {"measured", "lowest"}},
                 .reference = "invariance",
                 .excuse_of_driver = driver_chooses},
                [&](std::size_t k, std::size_t i, const Hit& hit) -> std::string {
                    if (!same_bits(hit, again[k].hits[i])) return "differs in a second run";
                    if (!hit.hit || hit.primitive_index == scene.lowest[hit.primitive_index]) return "";
                    return text("triangle ", hit.primitive_index, ", of which ", scene.lowest[hit.primitive_index],
                                " is a copy");
                });
}

// Counts answers that name a farther triangle than the nearest. A fault is one whose t the level can tell apart from
// the nearest one's.
void expect_order(CaseRun& run, const Measured& measured, const Mesh& mesh, std::span<const Ray> rays, Values params) {
    const World world = world_of(mesh);
    params.insert_or_assign("measured", "order");
    for (const Traced& traced : measured.traces) {
        double farther = 0;
        CaseRun::Outcome outcome{.params = params, .reference = "f64"};
        if (traced.configuration.level < Level::certified)
            outcome.only_measured = "the order is certified from certified on";
        outcome = ask_each(traced, rays, outcome, [&](std::size_t i, const Hit& hit) -> std::string {
            const ReferenceHit& nearest = measured.references[i];
            if (!hit.hit || !nearest.hit) return "";
            const ShearedRay line(dvec3(rays[i].origin), dvec3(rays[i].direction));
            const auto other = line.intersect(world.reference.geometry(0).find(hit.primitive_index)->vertices64());
            if (!other || other->t <= nearest.t) return "";
            ++farther;
            // Level certified tells apart 2^-46 of the terms of t, lower levels what t as a float can.
            const bool is_certified = traced.configuration.level == Level::certified;
            const double reach = length(dvec3(rays[i].origin)) / length(dvec3(rays[i].direction));
            if (is_certified ? other->t - nearest.t <= 0x1p-46 * (reach + other->t)
                             : static_cast<float>(other->t) == static_cast<float>(nearest.t))
                return "";
            return text("triangle ", hit.primitive_index, " at ", other->t, " before ", nearest.primitive, " at ",
                        nearest.t);
        });
        outcome.results = {{"farther", farther}};
        run.expect(traced.configuration, outcome);
    }
}

}  // namespace

// Copies of one triangle alone are met in the order of their ids, because their boxes are equal. Copies of different
// triangles with one centre of their boxes share a Morton code, and lie in nodes with different boxes.
void duplicates(CaseRun& run) {
    const Mesh soup = make_soup(200, 17, 0.4f);
    for (const std::size_t copies : {2, 4}) expect_lowest(run, "soup", soup, copies, run.amount(1'024, 100'000));
    Mesh one, centred;
    add_triangle(one, vec3(-1, -1, 0), vec3(1, -1, 0.5f), vec3(0, 1, 0.25f));
    expect_lowest(run, "one triangle", one, run.amount(2'000, 100'000), run.amount(64, 256));
    Random random(run.seed());
    for (int i = 0; i < 16; ++i) {
        const vec3 vertex = random.in_box(1);
        add_triangle(centred, vertex, -vertex, vertex * random.in_box(1));
    }
    expect_lowest(run, "one centre", centred, run.amount(8, 256), run.amount(1'024, 20'000));
}

// Alone, either mesh shows which t it would report; together, the smaller t counts, then the one that comes first.
void coplanar_tessellations(CaseRun& run) {
    const Mesh coarse = make_grid(5, 7), fine = make_grid(8, 8);
    Mesh both = coarse;
    append(both, fine);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 200'000); ++i)
        rays.push_back(ray_to(dvec3(random.between(0.1f, 0.9f), 0, random.between(0.1f, 0.9f)),
                              dvec3(random.in_box(1) + vec3(0.5f, 2, 0.5f))));
    const Measured measured = run.measure(world_of(both), rays);
    expect_refined_t(run, measured, rays, 1, {});
    const std::vector<Traced> first = run.trace(world_of(coarse), rays), second = run.trace(world_of(fine), rays);
    for (std::size_t k = 0; k < first.size(); ++k) {
        const Traced& traced = measured.traces[k];
        double of_the_second = 0;
        CaseRun::Outcome outcome{
            .params = {{"measured", "ids"}}, .reference = "invariance", .excuse_of_driver = driver_chooses};
        if (traced.configuration.level > Level::watertight)
            outcome.only_measured = "t is not what the order was decided by";
        outcome = ask_each(traced, rays, outcome, [&](std::size_t i, const Hit& hit) -> std::string {
            const Hit &a = first[k].hits[i], &b = second[k].hits[i];
            const bool is_first = hit.primitive_index < coarse.triangles.size();
            if (!is_first) ++of_the_second;
            if (!a.hit || !b.hit || !hit.hit) return "missed";
            return is_first == (a.t <= b.t) ? "" : text("t of the first: ", a.t, ", of the second: ", b.t);
        });
        outcome.results = {{"of_the_second", of_the_second}};
        run.expect(traced.configuration, outcome);
    }
}

// The farthest comes first, so that the lowest id is the wrong one.
void shells(CaseRun& run) {
    Mesh mesh;
    for (uint i = 8; i-- > 0;)
        append(mesh, make_quad(vec3(-2, -2, 1 + static_cast<float>(i) * 0x1p-23f), vec3(4, 0, 0), vec3(0, 4, 0)));
    for (const float distance : {0.5f, 1.0f, 10.0f})
        for (const bool is_slanted : {false, true}) {
            Random random(run.seed());
            std::vector<Ray> rays;
            for (std::size_t i = 0; i < run.amount(512, 100'000); ++i) {
                const float slope = is_slanted ? 0.1f : 0;
                rays.push_back({vec3(random.between(-1, 1), random.between(-1, 1), 1 - distance), 0,
                                vec3(random.between(-slope, slope), random.between(-slope, slope), 1), inf});
            }
            const Values params = {{"distance", distance}, {"slanted", is_slanted}};
            expect_order(run, run.measure(world_of(mesh), rays, {.params = params, .reps = 1}), mesh, rays, params);
        }
}

void fighting_sheets(CaseRun& run) {
    const Mesh near = moved(make_grid(24, 24, 0.1f, 3), vec3(0, 1.25f, 0));
    Mesh mesh = near;
    for (vec3& position : mesh.positions) position.y = std::nextafter(position.y, 0.0f);
    append(mesh, near);
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 1'000'000); ++i)
        rays.push_back(ray_to(dvec3(random.between(0.1f, 0.9f), 1.25f, random.between(0.1f, 0.9f)),
                              dvec3(random.in_box(0.5f) + vec3(0.5f, 3, 0.5f))));
    expect_order(run, run.measure(world_of(mesh), rays), mesh, rays, {});
}

// ---- Rays nearly in the planes of triangles, in them, and along edges.

// The plane contains two axes, so that heights above it are exact however small. Another plane is turned, and there the
// roundings of its vertices and of the rays limit the cosine.
void grazing(CaseRun& run) {
    const Mesh flat = moved(scaled(make_grid(16, 16), 4), vec3(-2, 0, -2));
    Random random(run.seed());
    const Transform rotation = random.rotation();
    Mesh turned_grid = flat;
    for (vec3& position : turned_grid.positions) position = transform_point(rotation, position);
    for (int exponent = 1; exponent <= 8; ++exponent) {
        const double cosine = std::pow(10.0, -exponent);
        std::vector<Ray> rays, turned_rays;
        for (std::size_t i = 0; i < run.amount(256, 50'000); ++i) {
            const vec3 target(random.between(-1, 1), 0, random.between(-1, 1));
            const double angle = double{random.between(0, 6.2831853f)}, distance = double{random.between(1, 4)};
            const dvec3 along(std::cos(angle), cosine, std::sin(angle));
            const vec3 origin(dvec3(target) + distance * along);
            rays.push_back({origin, 0, vec3(-along), inf});
            turned_rays.push_back(
                {transform_point(rotation, origin), 0, transform_vector(rotation, vec3(-along)), inf});
        }
        const Values params = {{"cosine", cosine}};
        expect_refined_t(run, run.measure(world_of(flat), rays, {.params = params, .reps = 1}), rays, 1, params);
        if (exponent > 5) continue;
        const Values turned_params = {{"cosine", cosine}, {"turned", true}};
        const Measured measured = run.measure(world_of(turned_grid), turned_rays, {.params = turned_params, .reps = 1});
        expect_refined_t(run, measured, turned_rays, 1, turned_params);
    }
}

// Vertices and rays lie exactly in these planes, also when seen along the ray: z = 0.375, and x = y.
void in_the_plane(CaseRun& run) {
    Random random(run.seed());
    for (const char* plane : {"z = 0.375", "x = y"}) {
        const auto placed = [&](float a, float b) { return *plane == 'z' ? vec3(a, b, 0.375f) : vec3(a, a, b); };
        const auto moving = [&](float a, float b) { return *plane == 'z' ? vec3(a, b, 0) : vec3(a, a, b); };
        const auto some = [&] { return random.between(-1, 1); };
        Mesh mesh;
        for (int i = 0; i < 32; ++i) {
            vec3 vertices[3];
            for (vec3& vertex : vertices) {
                const float a = some();
                vertex = placed(a, some());
            }
            add_triangle(mesh, vertices[0], vertices[1], vertices[2]);
        }
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
            const float a = 2 * some(), b = 2 * some(), c = some();
            rays.push_back({placed(a, b), 0, moving(c, some()), inf});
        }
        for (const Traced& traced : run.trace(world_of(mesh), rays)) {
            CaseRun::Outcome outcome =
                ask_each(traced, rays, {.params = {{"plane", plane}}, .reference = "exact"},
                         [](std::size_t, const Hit& hit) { return hit.hit ? text("hit at t = ", hit.t) : ""; });
            // Seen along the ray, x - y is 0 if a quotient of equal numbers is 1.
            if (*plane == 'x' && outcome.only_measured.empty())
                outcome.only_measured = why_bits_may_differ(run, traced.configuration);
            run.expect(traced.configuration, outcome);
        }
    }
}

// Rays come from outside, in the plane of a face and through the edges at its rim. All faces decide alike whether a ray
// is in or out, so it leaves as often as it enters.
void in_the_plane_of_a_face(CaseRun& run) {
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(1'024, 100'000); ++i) {
        const float height = i / 3 % 2 ? 1.0f : 0.0f;
        const float enter = random.between(0.25f, 0.75f), leave = random.between(0.25f, 0.75f);
        const float side = i / 6 % 2 ? 1.0f : -1.0f;
        const vec3 direction(side, leave - enter, 0);
        const vec3 edge(side > 0 ? 0.0f : 1.0f, enter, height);
        rays.push_back(
            {turned(edge - direction, static_cast<int>(i % 3)), 0, turned(direction, static_cast<int>(i % 3)), inf});
    }
    // In the lower planes, the rule for ties lets the box begin, and in the upper ones it has ended, or the other way
    // round.
    std::size_t met = 0;
    const auto is_even = [&](const Ray&, uint count) {
        met += count == 2;
        return count % 2 == 0;
    };
    run.count_crossings(world_of(make_box(vec3(0), vec3(1)), {}, {.non_opaque = true}), rays, is_even);
    if (met == 0) fail("no ray was counted to cross the box twice");
}

// Uses a sphere with vertices at multiples of 16, so that rays through vertices and middles of edges are exact.
void tied_axes(CaseRun& run) {
    Mesh sphere = make_icosphere(2, 64);
    for (vec3& position : sphere.positions) position = round(position) * 16.0f;
    Random random(run.seed());
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < run.amount(2'048, 200'000); ++i) {
        const uvec3& triangle = sphere.triangles[i % sphere.triangles.size()];
        const vec3 a = sphere.positions[triangle.x], b = sphere.positions[triangle.y];
        const auto sign = [&] { return random.between(-1, 1) < 0 ? -1.0f : 1.0f; };
        vec3 direction(sign(), sign(), 0);
        direction.z = sign() * (i % 2 ? 1.0f : 0.5f);
        direction = turned(direction, static_cast<int>(i % 3));
        // The ray goes towards the middle, so that it does not meet a silhouette.
        const vec3 target = i % 4 < 2 ? a : (a + b) * 0.5f;
        if (dot(direction, target) > 0) direction = -direction;
        rays.push_back({target - 512.0f * direction, 0, direction, inf});
    }
    run.measure(world_of(sphere), rays);
}

// Each ray is as long as the edge or diagonal, so that the far end is at t = 1.
void along_edges(CaseRun& run) {
    const World world = world_of(make_box(vec3(1), vec3(2)));
    std::vector<Ray> rays;
    std::vector<bool> is_inward;
    for (int vertex = 0; vertex < 8; ++vertex)
        for (int way = 1; way < 8; ++way)
            for (const float sign : {1.0f, -1.0f}) {
                vec3 origin(1), direction(0);
                for (int axis = 0; axis < 3; ++axis) {
                    if (vertex >> axis & 1) origin[axis] = 2;
                    if (way >> axis & 1) direction[axis] = sign * (vertex >> axis & 1 ? -1.0f : 1.0f);
                }
                rays.push_back({origin, 0, direction, inf});
                is_inward.push_back(sign > 0);
            }
    expect_each(run, run.trace(world, rays), rays, {.reference = "exact"},
                [&](std::size_t, std::size_t i, const Hit& hit) -> std::string {
                    const vec3 size = abs(rays[i].direction);
                    const bool is_through = is_inward[i] && size.x + size.y + size.z == 3;
                    if (!hit.hit) return is_through ? "missed the far vertex" : "";
                    return is_inward[i] && std::abs(hit.t - 1) <= 0x1p-22f ? "" : text("hit at t = ", hit.t);
                });
}

namespace {

// A triangle of whole numbers, and a ray from within it, or from 2^-4 off its plane; its line meets the triangle
// inside.
struct Departing {
    std::array<vec3, 3> corners;
    Ray ray;
    bool hits;
};

std::optional<Departing> departing(Random& random, vec3 at) {
    const auto whole = [&] { return 4.0f * static_cast<float>(random.below(1'025)) - 2'048.0f; };
    const auto lattice = [&] {
        const float x = whole(), y = whole();
        return vec3(x, y, whole());
    };
    const vec3 first = lattice(), second = lattice();
    vec3 off = vec3(0);
    if (const uint which = random.below(4); which < 3) off[which] = random.below(2) ? 0x1p-4f : -0x1p-4f;
    const vec3 from = (first + second) * 0.25f + off;
    vec3 way = random.direction();
    if (random.below(2)) {
        const float u = random.between(-1, 1), v = random.between(-1, 1);
        way = u * first + v * second + 10.0f * way;
    }
    // From here on, all is exact in float64 but the division.
    const dvec3 normal = cross(dvec3(first), dvec3(second));
    const double above = -dot(normal, dvec3(from)), along = dot(normal, dvec3(way));
    if (dot(normal, normal) == 0 || std::abs(along) < 1e-3 * length(normal) * length(dvec3(way))) return {};
    const double t = above / along;
    const dvec3 met = dvec3(from) + t * dvec3(way), u = cross(met, dvec3(second)), v = cross(dvec3(first), met);
    const double share_u = dot(u, normal) / dot(normal, normal), share_v = dot(v, normal) / dot(normal, normal);
    if (t > 0.5 || share_u < 0.01 || share_v < 0.01 || share_u + share_v > 0.99) return {};
    return Departing{{at, at + first, at + second}, {at + from, 0, way, 1}, t > 0};
}

}  // namespace

void from_the_plane(CaseRun& run) {
    Random random(run.seed());
    Mesh mesh;
    std::vector<Ray> rays;
    std::vector<bool> hits;
    for (std::size_t i = 0; i < run.amount(2'048, 65'536); ++i) {
        // They are too far apart for a ray to meet another one.
        const vec3 at = 16'384.0f * vec3(i % 40, i / 40 % 40, i / 1'600);
        const std::optional<Departing> made = departing(random, at);
        if (!made) continue;
        add_triangle(mesh, made->corners[0], made->corners[1], made->corners[2]);
        rays.push_back(made->ray);
        hits.push_back(made->hits);
    }
    for (const Query query : {Query::closest, Query::any})
        for (const Traced& traced : run.trace(world_of(mesh), rays, query)) {
            CaseRun::Outcome outcome{.params = {{"query", query == Query::any ? "any" : "closest"}},
                                     .reference = "exact",
                                     .excuse_of_driver = "Vulkan demands no exact sign of t"};
            if (!is_robust(traced.configuration)) outcome.control = "fast";
            run.expect(traced.configuration, ask_each(traced, rays, outcome, [&](std::size_t i, const Hit& hit) {
                           return (hit.hit != 0) == hits[i] ? "" : hit.hit ? text("hit at t = ", hit.t) : "missed";
                       }));
        }
}

}  // namespace twinray::suite
