#include <cmath>
#include <numbers>

#include "analysis_count_free.spv.h"
#include "analysis_sky_rays.spv.h"
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

namespace {

// Patches of Tregenza's rows, 12 degrees high each, from the horizon to the zenith's patch of half the height.
constexpr int tregenza_rows[] = {30, 30, 24, 24, 18, 12, 6};

int divisions_of(std::string_view name) {
    if (name == sky_names[0]) return 1;
    if (name == sky_names[1]) return 2;
    if (name == sky_names[2]) return 4;
    fail("sky '", std::string(name), "' is not one of tregenza145, reinhart577, reinhart2305");
}

}  // namespace

std::vector<SkyPatch> sky_patches(std::string_view name) {
    using std::numbers::pi;
    const int m = divisions_of(name);
    const int rows = static_cast<int>(std::size(tregenza_rows)) * m;
    const double height = pi / 2 / (rows + 0.5);
    std::vector<SkyPatch> patches;
    for (int row = 0; row < rows; ++row) {
        const int count = tregenza_rows[row / m] * m;
        const double altitude = (row + 0.5) * height;
        const double area = 2 * pi / count * (std::sin((row + 1) * height) - std::sin(row * height));
        for (int i = 0; i < count; ++i) {
            const double azimuth = 2 * pi * i / count;
            patches.push_back({dvec3(std::sin(azimuth) * std::cos(altitude), std::cos(azimuth) * std::cos(altitude),
                                     std::sin(altitude)),
                               area});
        }
    }
    patches.push_back({dvec3(0, 0, 1), 2 * pi * (1 - std::sin(rows * height))});
    return patches;
}

namespace {

uint faces_of_batch(uint samples, std::size_t faces) {
    if (samples < 1 || samples > rays_of_batch)
        fail("rays from faces: ", samples, " per face; must be 1 to ", rays_of_batch);
    return static_cast<uint>(std::min<std::size_t>(rays_of_batch / samples, faces));
}

}  // namespace

SkyRays::SkyRays(AbstractAccel& accel, const Faces& faces, const SkyRaysDesc& desc)
    : accel_(accel),
      faces_(faces),
      desc_(desc),
      faces_of_batch_(faces_of_batch(desc.samples, faces.count())),
      rays_kernel_(accel.context(), {.name = "analysis_sky_rays", .spirv = analysis_sky_rays_spirv}),
      count_kernel_(accel.context(), {.name = "analysis_count_free", .spirv = analysis_count_free_spirv}) {
    const std::uint64_t rays = std::uint64_t{faces_of_batch_} * desc.samples;
    rays_ = Buffer(accel.context(), {.name = "face rays", .bytes = rays * sizeof(Ray)});
    hits_ = Buffer(accel.context(), {.name = "face hits", .bytes = rays * sizeof(Hit)});
    counts_ = Buffer(accel.context(), {.name = "free rays of faces", .bytes = faces.count() * sizeof(GroupCount)});
    accel.sync();
}

std::vector<GroupCount> SkyRays::trace(dvec3 towards, bool to_sun, uint stream) const {
    if (desc_.first_face >= std::min(desc_.last_face, faces_.count())) return std::vector<GroupCount>(faces_.count());
    SkyRaysArgs args{.table = faces_.state().table(),
                     .rays = rays_.ref<Ray>(),
                     .towards = vec3(unit_direction(towards)),
                     .to_sun = to_sun,
                     .front_only = desc_.sides == Sides::front,
                     .first_face = 0,
                     .ray_count = 0,
                     .samples = desc_.samples,
                     .rows = static_cast<uint>(std::sqrt(desc_.samples)),
                     .stream = stream,
                     .seed_low = static_cast<uint>(desc_.seed),
                     .seed_high = static_cast<uint>(desc_.seed >> 32)};
    Pace pace(accel_.context());
    const std::uint64_t last = std::min<std::uint64_t>(desc_.last_face, faces_.count());
    for (std::uint64_t first = desc_.first_face; first < last; first += faces_of_batch_) {
        args.first_face = static_cast<uint>(first);
        args.ray_count = desc_.samples * static_cast<uint>(std::min<std::uint64_t>(faces_of_batch_, last - first));
        Commands commands(accel_.context(), "rays from faces");
        if (first == desc_.first_face) {
            const auto pass = commands.pass("rays from faces start");
            commands.fill(counts_, 0, counts_.bytes(), 0);
        }
        record(commands, args, pace);
        pace.finish(commands);
        if (desc_.progress) desc_.progress(args.ray_count);
    }
    return download<GroupCount>(accel_.context(), counts_, faces_.count());
}

void SkyRays::record(Commands& commands, SkyRaysArgs args, Pace& pace) const {
    rays_kernel_.dispatch(commands, args, args.ray_count);
    accel_.trace(commands, accel_.view(),
                 {.rays = args.rays,
                  .hits = hits_.ref<Hit>(),
                  .count = args.ray_count,
                  .query = Query::any,
                  .occlusion_only = true},
                 pace);
    const uint pairs = args.ray_count / args.samples * ((args.samples + 1) / 2);
    count_kernel_.dispatch(
        commands, {args.rays, hits_.ref<Hit>(), counts_.ref<GroupCount>(), args.first_face, args.samples, pairs, 0},
        pairs);
}

}  // namespace twinray
