// SPDX-License-Identifier: MIT
#include "viewer/pick.h"

#include <algorithm>
#include <sstream>

#include "twinray/glsl/vector_math.h"
#include "viewer/picture/face_picture.h"
#include "report/replay/explain.h"
#include "report/replay/scene_file.h"

namespace twinray::viewer {
namespace {

std::string text_of(const Hit& hit) {
    std::ostringstream out;
    out.precision(9);
    if (hit.hit == 0) return "a miss";
    out << "t " << hit.t << ", instance " << hit.instance_index << ", triangle " << hit.primitive_index << ", u "
        << hit.u << ", v " << hit.v;
    return out.str();
}

std::string text_of(const ReferenceHit& hit) {
    std::ostringstream out;
    out.precision(17);
    if (!hit.hit) return "a miss";
    out << "t " << hit.t << ", instance " << hit.instance << ", triangle " << hit.primitive;
    return out.str();
}

}  // namespace

Pick pick(Stage& stage, const Ray& ray) {
    Pick found;
    found.ray = ray;
    const std::span<const Ray> one(&ray, 1);
    found.software = stage.software().closest_hits(one)[0];
    found.reference = stage.reference().closest_hit(ray);
    found.software_class = stage.reference().classify(ray, found.software, TracedBy::software);
    if (stage.hardware()) {
        found.has_hardware = true;
        found.hardware = stage.hardware()->closest_hits(one)[0];
        found.hardware_class = stage.reference().classify(ray, found.hardware, TracedBy::hardware);
    }
    if (found.software.hit) {
        found.point = dvec3(ray.origin) + dvec3(ray.direction) * double(found.software.t);
        found.face = first_faces(stage.scene())[found.software.instance_index] + found.software.primitive_index;
    }
    reference::Scene::take_steps();
    (void)stage.cpu_reference().trace(ray);
    const TraversalSteps steps = reference::Scene::take_steps();
    found.nodes = steps.nodes, found.boxes = steps.boxes, found.primitives = steps.primitives;
    return found;
}

std::string text_of(const Pick& pick) {
    std::ostringstream out;
    out.precision(9);
    out << "ray from " << pick.ray.origin.x << ' ' << pick.ray.origin.y << ' ' << pick.ray.origin.z << " along "
        << pick.ray.direction.x << ' ' << pick.ray.direction.y << ' ' << pick.ray.direction.z << '\n'
        << "software: " << text_of(pick.software) << ": " << name_of(pick.software_class) << '\n';
    if (pick.has_hardware)
        out << "hardware: " << text_of(pick.hardware) << ": " << name_of(pick.hardware_class) << '\n';
    out << "float64: " << text_of(pick.reference) << '\n'
        << "steps of the software tree: " << pick.nodes << " nodes, " << pick.boxes << " boxes, " << pick.primitives
        << " triangles\n";
    return out.str();
}

std::string explanation_of(Stage& stage, const Pick& pick) {
    std::vector<exact::TriangleId> triangles;
    const auto add = [&](bool is_hit, uint instance, uint primitive) {
        if (is_hit && !std::ranges::count(triangles, exact::TriangleId{instance, primitive}))
            triangles.push_back({instance, primitive});
    };
    add(pick.software.hit != 0, pick.software.instance_index, pick.software.primitive_index);
    add(pick.has_hardware && pick.hardware.hit != 0, pick.hardware.instance_index, pick.hardware.primitive_index);
    add(pick.reference.hit, pick.reference.instance, pick.reference.primitive);
    std::ostringstream out;
    const replay::Explainer explainer(stage.scene(), stage.reference().scene(), pick.ray, Level::watertight);
    for (const exact::TriangleId& triangle : triangles) {
        explainer.print_test(out, triangle);
        explainer.print_boxes(out, triangle);
    }
    return out.str();
}

replay::Replay replay_of(Stage& stage, const Pick& pick, const std::string& version) {
    const bool is_of_hardware = pick.has_hardware && is_fault_of_hardware(pick.hardware_class);
    const DeviceProperties& device = stage.context().properties();
    return {.scene = std::filesystem::absolute(stage.file()),
            .scene_hash = replay::hash_of(stage.scene()),
            .backend = is_of_hardware ? "hw" : "sw",
            .level = std::string(name_of(Level::watertight)),
            .kind = std::string(name_of(is_of_hardware ? pick.hardware_class : pick.software_class)),
            .ray = pick.ray,
            .answer = is_of_hardware ? pick.hardware : pick.software,
            .reference = pick.reference,
            .device = device.name,
            .driver = device.driver,
            .twinray = version};
}

}  // namespace twinray::viewer
