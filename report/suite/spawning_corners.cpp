// SPDX-License-Identifier: MIT
// Rays that leave a surface close to another one, which they must meet, or must not.
#include <algorithm>
#include <cmath>

#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include "report/suite/spawning.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

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

// Rays leave the middle of a plate upwards, so steeply that all end on the plate above.
void leave_between_plates(CaseRun& run) {
    const Spawner spawner(run.devices().context(Backend::software));
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
    const Spawner spawner(run.devices().context(Backend::software));
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
