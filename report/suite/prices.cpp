// SPDX-License-Identifier: MIT
// What each level costs on scenes of an ordinary size, and what it is worth there.
#include "report/suite/case_run.h"
#include "report/suite/feature_costs.h"
#include <twinray/scene.h>

#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/aimed_rays.h"
#include "report/suite/shapes.h"

namespace twinray::suite {
namespace {

// 65,536 and 2^20 of them.
std::vector<Ray> camera_rays(CaseRun& run, const Bounds& bounds) {
    return primary_rays(bounds, static_cast<uint>(run.amount(256, 1024)));
}

void measure_scene(CaseRun& run, const Scene& scene, std::span<const Ray> rays, std::string_view kind) {
    run.measure(world_of(scene), rays,
                {.params = {{"triangles", count_triangles(scene)},
                            {"instances", scene.instances.size()},
                            {"rays", std::string(kind)}}});
}

void closed_mesh(CaseRun& run) {
    Scene scene;
    scene.meshes = {make_icosphere(static_cast<uint>(run.amount(6, 8)))};
    scene.instances = {{"", 0, Transform{}}};
    measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
}

void room(CaseRun& run) {
    const Scene scene = cornell_box_scene();
    measure_scene(run, scene, random_rays(bounds_of(scene), run.amount(65'536, 1 << 20), run.seed()), "incoherent");
}

void instanced_spheres(CaseRun& run) {
    Scene scene;
    scene.meshes = {make_icosphere(3)};
    const int side = static_cast<int>(run.amount(8, 32));
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y) {
            const vec3 place(2.5f * static_cast<float>(x), static_cast<float>((x * 7 + y * 3) % 5),
                             2.5f * static_cast<float>(y));
            scene.instances.push_back({"", 0, Transform::translation(place) * Transform::scaling({1, 0.7f, 1.3f})});
        }
    measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
}

}  // namespace

std::vector<SuiteCase> price_cases() {
    const std::string criterion = "0 faults; the time is measured";
    return {
        {"L01", "a closed mesh, a camera's rays", "time and error of each level", criterion, closed_mesh},
        {"L02", "a room of few triangles, incoherent rays", "time and error of each level", criterion, room},
        {"L03", "many instances, a camera's rays", "time and error of each level", criterion, instanced_spheres},
        {"L04", "a closed mesh, by kernels to which features are added that it does not need",
         "time over the needed alone", "the same hits; the time is measured", feature_costs},
    };
}

std::vector<SuiteCase> scene_cases(std::span<const std::filesystem::path> files) {
    std::vector<SuiteCase> cases;
    for (const std::filesystem::path& file : files) {
        const std::string id = text("L", cases.size() + 11);
        cases.push_back({id, file.filename().string() + ", a camera's rays", "time and error of each level",
                         "0 faults; the time is measured", [file](CaseRun& run) {
                             const Scene scene = load_scene(file);
                             measure_scene(run, scene, camera_rays(run, bounds_of(scene)), "primary");
                         }});
    }
    return cases;
}

}  // namespace twinray::suite
