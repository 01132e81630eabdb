// SPDX-License-Identifier: MIT
// All hits of rays through layers of known number and places.
#include <twinray/queries.h>

#include <algorithm>
#include <cmath>

#include "report/suite/scenes.h"
#include "report/suite/sections.h"
#include <twinray/geometry.h>

namespace twinray::suite {
namespace {

// Makes triangles over [0, 1]^2 at these heights, from below upwards.
Mesh layers(std::span<const float> heights) {
    Mesh mesh;
    for (const float z : heights) add_triangle(mesh, vec3(-1, -1, z), vec3(3, -1, z), vec3(-1, 3, z));
    return mesh;
}

// Makes rays upwards, slightly aslant, so that none passes an edge.
std::vector<Ray> upward_rays(std::size_t count) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        rays.push_back({vec3(x * 0.5f, 0.25f, -1), 0, vec3(0.0001f * x, 0, 1), INFINITY});
    }
    return rays;
}

std::vector<Configuration> configurations_of(CaseRun& run) {
    std::vector<Configuration> chosen = run.crossing_configurations();
    std::erase_if(chosen, [](const Configuration& one) { return one.level != Level::watertight; });
    return chosen;
}

// Returns how many rays do not meet triangle i as their hit i.
std::uint64_t wrong_rays(const HitsOfRays& found, std::size_t rays, std::size_t layer_count) {
    std::uint64_t wrong = 0;
    for (std::size_t ray = 0; ray < rays; ++ray) {
        const std::span<const Hit> hits = found.of(ray);
        bool is_right = hits.size() == layer_count;
        for (std::size_t i = 0; is_right && i < hits.size(); ++i) is_right = hits[i].primitive_index == i;
        wrong += !is_right;
    }
    return wrong;
}

ErrorFigures t_error_of(const HitsOfRays& found, std::span<const float> heights) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < found.hits.size(); ++i) {
        const Hit& hit = found.hits[i];
        const float t = heights[hit.primitive_index] + 1;  // exact
        errors.push_back(std::abs(double{hit.t} - double{t}) / double{std::nextafter(t, INFINITY) - t});
    }
    if (errors.empty()) return {"t_ulp", 0, 0, {0, 0}, 0, 0};
    return error_figures("t_ulp", std::move(errors), 0);
}

void measure_layers(CaseRun& run, std::span<const float> heights, std::size_t ray_count, const Values& params) {
    const Mesh mesh = layers(heights);
    const std::vector<Ray> rays = upward_rays(ray_count);
    for (const Configuration& configuration : configurations_of(run)) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(mesh);
        AllHits all(accel);
        HitsOfRays found = all(rays);
        std::vector<double> times;
        for (int rep = 0; rep < 3; ++rep) {
            const Stopwatch start;
            found = all(rays);
            times.push_back(start.ms() * 1e6 / static_cast<double>(std::max<std::size_t>(found.hits.size(), 1)));
        }
        Record record = run.record(configuration);
        record.params = params;
        record.reference = "analytic";
        set_faults(record, wrong_rays(found, rays.size(), heights.size()), rays.size());
        record.error = t_error_of(found, heights);
        record.time = time_figures("ns_per_hit", times);
        frame::decide(record, is_ours(configuration.backend) ? "twinray" : "driver");
        if (!*record.pass) record.reason = "not every layer is met once, in order";
        run.add(record);
    }
}

}  // namespace

void all_hits_through_layers(CaseRun& run) {
    for (const std::size_t count : {4u, 16u, 64u, 256u}) {
        std::vector<float> heights;
        for (std::size_t i = 0; i < count; ++i) heights.push_back(static_cast<float>(i) / 64);
        measure_layers(run, heights, run.amount(1'024, 65'536), {{"layers", count}});
    }
}

void all_hits_through_copies(CaseRun& run) {
    const std::vector<float> heights(run.amount(2'000, 20'000), 0.0f);
    measure_layers(run, heights, 64, {{"copies", heights.size()}});
}

}  // namespace twinray::suite
