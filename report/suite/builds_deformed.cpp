// SPDX-License-Identifier: MIT
// Vertices that skins and morph targets move on the device, and refits to them.
#include <twinray/geometry.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/scene/rig.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"

namespace twinray::suite {
namespace {

// Errors are in 2^-24 of the mesh's size. A vertex is a dozen sums of numbers up to four times as large.
constexpr double most_error = 32;

// Returns joints of a sphere: one turns, one flattens it, one is at infinity and has no weight.
std::vector<Rig::Node> joints(float size, Random& random) {
    std::vector<Rig::Node> nodes(3);
    const auto part = [&] { return double{random.between(-0.5f, 0.5f)}; };
    nodes[0].rest.rotation = {part(), part(), part(), 1};
    nodes[0].rest.translation = dvec3(random.in_box(0.5f * size));
    nodes[1].rest.scale = {1, 0, 1};
    nodes[2].rest.translation = dvec3(INFINITY);
    return nodes;
}

// Returns displacements of two targets. The second ones are NaN; the pose takes half of the first and none of the
// second.
VertexMotion motion(std::size_t vertices, float size, Random& random) {
    VertexMotion motion;
    motion.targets.resize(2);
    motion.influences = 3;
    for (std::size_t i = 0; i < vertices; ++i) {
        motion.targets[0].positions.push_back(random.in_box(0.1f * size));
        motion.targets[1].positions.push_back(vec3(nan));
        const float turned = 0.25f * static_cast<float>(random.below(5));
        motion.joints.insert(motion.joints.end(), {0, 1, 2});
        motion.weights.insert(motion.weights.end(), {turned, 1 - turned, 0});
    }
    return motion;
}

std::shared_ptr<const Rig> rig_of(const Mesh& mesh, float size, std::uint64_t seed) {
    Random random(seed);
    auto rig = std::make_shared<Rig>();
    rig->nodes = joints(size, random);
    rig->nodes.emplace_back().weights = {0.5, 0};
    rig->skins.push_back({"skin", {0, 1, 2}, std::vector(3, glm::dmat4(1))});
    rig->meshes.push_back({.mesh = 0,
                           .node = 3,
                           .skin = 0,
                           .base = {mesh.positions, {}, {}},
                           .motion = motion(mesh.positions.size(), size, random)});
    return rig;
}

// Poses the mesh and moves the accelerator's to it. Keeps its buffers in `deformers`.
const Buffer& pose(AbstractAccel& accel, AccelHandle handle, const std::shared_ptr<const Rig>& rig,
                   std::vector<std::unique_ptr<Deformer>>& deformers) {
    Context& context = accel.context();
    Deformer& deformer = *deformers.emplace_back(std::make_unique<Deformer>(context, rig));
    Commands commands(context, "suite pose");
    deformer.record(commands, rest_pose(*rig));
    commands.submit();
    const Deformer::Output output = deformer.output(0);
    accel.update_vertices(handle, output.positions.ref<float>(), output.vertex_count);
    return output.positions;
}

CaseRun::Outcome outcome_of(std::span<const vec3> found, std::span<const vec3> right, float size) {
    CaseRun::Outcome outcome{.params = {{"size", size}}, .n = found.size(), .reference = "f64"};
    double largest = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double error = length(dvec3(found[i]) - dvec3(right[i])) / (double{size} * 0x1p-24);
        largest = std::max(largest, error);
        if (!(error <= most_error) && outcome.faults++ == 0)
            outcome.what = text("vertex ", i, " is off by ", error, " of 2^-24 of the size");
    }
    outcome.results = {{"largest_error", largest}};
    return outcome;
}

}  // namespace

void deformed_meshes_on_device(CaseRun& run) {
    for (const float size : {1e-15f, 1.0f, 1e15f}) {
        Mesh mesh = scaled(make_icosphere(3), size);
        const Mesh bound = mesh;
        const std::shared_ptr<const Rig> rig = rig_of(mesh, size, run.seed());
        std::vector<std::unique_ptr<Deformer>> deformers;  // until all have traced
        const Configuration one = run.one_configuration_each().front();
        AbstractAccel& accel = run.devices().empty_accel(one);
        const Buffer& moved = pose(accel, accel.push(mesh), rig, deformers);
        mesh.positions = download<vec3>(accel.context(), moved, mesh.positions.size());
        accel.sync();
        run.expect(one, outcome_of(mesh.positions, deformed(*rig, 0, rest_pose(*rig)).positions, size));
        CaseRun::Outcome control = outcome_of(bound.positions, mesh.positions, size);
        control.control = "vertices that stay";
        run.expect(one, control);
        const World world{[&](AbstractAccel& to) { pose(to, to.push(bound), rig, deformers); },
                          world_of(mesh).reference};
        run.measure(world, mixed_rays(world, bounds_of(mesh), run.amount(1'024, 200'000), run.seed()),
                    {.params = {{"size", size}}, .reps = 1});
    }
}

}  // namespace twinray::suite
