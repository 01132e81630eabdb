// SPDX-License-Identifier: MIT
#include "engine/analysis/estimate.h"
#include "engine/analysis/ray_grid.h"
#include "engine/analysis/sky_rays.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"

namespace twinray {
namespace {

void check_positions(std::span<const SunPosition> positions) {
    for (const SunPosition& position : positions) {
        unit_direction(position.direction);
        if (!(position.hours >= 0) || !std::isfinite(position.hours))
            fail("sun hours: a position has ", position.hours, " hours; they must be finite and not negative");
    }
    if (positions.size() > UINT32_MAX) fail("sun hours: ", positions.size(), " positions; at most ", UINT32_MAX);
}

// Sums over the positions, by face.
struct HoursOfFace {
    double hours = 0;
    double squared_differences = 0;  // of pairs of rays, in squares of hours
    double possible = 0;             // while the sides that count were turned to the sun
    std::uint64_t free_rays = 0;
};

void add_position(std::vector<HoursOfFace>& sums, std::span<const GroupCount> counts, double hours_of_ray) {
    for (std::size_t face = 0; face < sums.size(); ++face) {
        sums[face].hours += counts[face].hits * hours_of_ray;
        sums[face].squared_differences += counts[face].odd * hours_of_ray * hours_of_ray;
        sums[face].free_rays += counts[face].hits;
    }
}

void add_possible(std::vector<HoursOfFace>& sums, const Faces& faces, const SunPosition& position, Sides sides) {
    const dvec3 towards = -unit_direction(position.direction);
    parallel_for(sums.size(), [&](std::size_t face) {
        const double turned = dot(area_vector(faces.state().placed, faces[face]), towards);
        if (sides == Sides::both ? turned != 0 : turned > 0) sums[face].possible += position.hours;
    });
}

// Returns the light that an unobstructed face receives from the sky.
double open_sky(dvec3 area_vector, dvec3 zenith, Sides sides) {
    return sides == Sides::both ? 1 : (1 + dot(normalize(area_vector), zenith)) / 2;
}

std::uint64_t asked(const Faces& faces, const SkyRaysDesc& desc) {
    const std::size_t last = std::min(desc.last_face, faces.count());
    return last - std::min(desc.first_face, last);
}

Received received(std::uint64_t free_rays, double possible, double value, const Interval& interval) {
    const Estimate estimate = within({0, possible}, value, interval);
    return {free_rays, estimate.value, estimate.interval_95};
}

}  // namespace

SkyLight sky_light(AbstractAccel& accel, const Faces& faces, dvec3 zenith, const SkyRaysDesc& desc) {
    check_faces(accel, faces, "sky light");
    const dvec3 up = unit_direction(zenith);
    const SkyRays rays(accel, faces, desc);
    SkyLight light{.faces = std::vector<Received>(faces.count()), .ray_count = asked(faces, desc) * desc.samples};
    const std::vector<GroupCount> counts = rays.free_to_sky(up);
    for (std::size_t face = desc.first_face; face < std::min(counts.size(), desc.last_face); ++face) {
        if (faces.areas()[face] == 0) continue;
        const double samples = desc.samples;
        const Interval free = paired_count_interval_95(counts[face].hits, counts[face].odd, desc.samples);
        const double open = open_sky(area_vector(faces.state().placed, faces[face]), up, desc.sides);
        light.faces[face] =
            received(counts[face].hits, open, counts[face].hits / samples, {free.low / samples, free.high / samples});
    }
    return light;
}

SkyLight sun_hours(AbstractAccel& accel, const Faces& faces, std::span<const SunPosition> positions,
                   const SkyRaysDesc& desc) {
    check_faces(accel, faces, "sun hours");
    check_positions(positions);
    const SkyRays rays(accel, faces, desc);
    std::vector<HoursOfFace> sums(faces.count());
    double most = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double hours_of_ray = positions[i].hours / desc.samples;
        most = std::max(most, hours_of_ray);
        add_position(sums, rays.free_to_sun(-positions[i].direction, static_cast<uint>(i)), hours_of_ray);
        add_possible(sums, faces, positions[i], desc.sides);
    }
    SkyLight light{.faces = std::vector<Received>(faces.count()),
                   .ray_count = asked(faces, desc) * desc.samples * positions.size()};
    for (std::size_t face = desc.first_face; face < std::min(sums.size(), desc.last_face); ++face) {
        if (faces.areas()[face] == 0) continue;
        const HoursOfFace& sum = sums[face];
        const double margin = paired_margin(sum.squared_differences, most, 0.05);
        light.faces[face] = received(sum.free_rays, sum.possible, sum.hours, {sum.hours - margin, sum.hours + margin});
    }
    return light;
}

}  // namespace twinray
