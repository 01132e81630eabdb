// SPDX-License-Identifier: MIT
// The shadow terminator: where light of smooth normals ends on coarse meshes. Shadow rays leave by the geometric
// normal, so that facets that face away from a light are black whatever their vertices' normals are. Facets that face
// it are lit no further than these normals allow.
#include <twinray/geometry.h>
#include <twinray/scene.h>

#include "renderer/reference.h"
#include "report/suite/estimators.h"
#include "report/suite/pictures.h"
#include "report/suite/scenes.h"
#include "report/suite/sections.h"

namespace twinray::suite {
namespace {

constexpr uint finest = 6;  // subdivisions of an icosahedron: 81,920 triangles
constexpr uint triangles_of(uint subdivisions) { return 20u << 2 * subdivisions; }

// Makes unit spheres in a row along y, turned so that no edges lie where light ends: one of the finest, then from 1 to
// `coarse` subdivisions. Light comes along -x, from a square half a degree wide.
Scene spheres_lit_from_the_side(uint coarse, std::uint64_t seed) {
    Scene scene;
    Random random(seed);
    const Transform turn = random.rotation();
    for (uint i = 0; i <= coarse; ++i) {
        add(scene, make_icosphere(i == 0 ? finest : i), lambert(0.5f));
        scene.instances.back().transform = Transform::translation({0, 3 * static_cast<float>(i), 0}) * turn;
    }
    add(scene, make_quad({1000, -5, -5}, {0, 0, 10}, {0, 10, 0}), lamp(10'000));
    return scene;
}

// Looks at the middle of a sphere's side, half of which is lit.
path_tracer::CameraRays look_at_sphere(uint i) {
    const float y = 3 * static_cast<float>(i);
    return look({0, y, 4}, {0, y, 0}, 0.15f);
}

std::vector<double> luminances(const HdrImage& picture) {
    std::vector<double> all;
    for (const vec3& pixel : picture.rgb) all.push_back(static_cast<double>(path_tracer::luminance(pixel)));
    return all;
}

}  // namespace

void shadow_terminator(CaseRun& run) {
    const auto spp = static_cast<uint>(run.amount(8, 256)), coarse = static_cast<uint>(run.amount(2, 4));
    RenderDesc desc{.scene = spheres_lit_from_the_side(coarse, run.seed())};
    desc.settings.width = desc.settings.height = static_cast<uint>(run.amount(24, 256));
    desc.settings.max_depth = 1;  // light that nothing else has reflected
    std::vector<Configuration> configurations = analysis_configurations(run);
    // All configurations show the same, and each compiles the path tracer.
    if (!run.is_whole() && configurations.size() > 1) configurations.resize(1);
    for (const Configuration& configuration : configurations) {
        RenderFixture fixture(run, configuration, desc);
        const auto shown = [&](uint i) {
            fixture.set_camera(look_at_sphere(i));
            return luminances(fixture.expose(run.seed(), spp).picture);
        };
        const std::vector<double> fine = shown(0);
        const double least = *std::ranges::max_element(fine) / 100;  // of what counts as lit
        for (uint i = 1; i <= coarse; ++i) {
            const std::vector<double> seen = shown(i);
            std::uint64_t lit = 0, black = 0;
            double light = 0, fine_light = 0;
            for (std::size_t pixel = 0; pixel < fine.size(); ++pixel) {
                light += seen[pixel], fine_light += fine[pixel];
                if (fine[pixel] < least) continue;
                ++lit;
                black += seen[pixel] == 0;
            }
            Record record = run.record(configuration);
            record.params = {{"triangles", triangles_of(i)}};
            record.reference = text("a sphere of ", triangles_of(finest), " triangles");
            record.n = lit;
            record.counts = {{"BLACK", black}};
            record.results = {{"black_share", static_cast<double>(black) / static_cast<double>(lit)},
                              {"energy_ratio", light / fine_light}};
            if (i == coarse) fixture.census().add_to(record);
            run.add(record);
        }
    }
}

}  // namespace twinray::suite
