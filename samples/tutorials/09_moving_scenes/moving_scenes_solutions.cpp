// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <cmath>
#include <iostream>

#include "scene.h"

// [exercise1]
// The device's work for some commands: the tutorial's own kernels, and all passes of the sync.
struct Work {
    double kernels_ms = 0, sync_ms = 0;
    std::size_t sync_passes = 0;
};

Work work_of(const Commands& commands) {
    Work work;
    for (const PassTiming& pass : commands.timings()) {
        const bool is_ours = pass.name == "waves" || pass.name == "float balls";
        (is_ours ? work.kernels_ms : work.sync_ms) += pass.ms;
        work.sync_passes += !is_ours;
    }
    return work;
}

std::vector<Work> work_of_frames(Pond& pond, Context& context) {
    std::vector<Work> frames;
    for (uint frame = 0; frame < 4; ++frame) {
        Commands commands(context, "frame");
        pond.move(commands, 0.1f * static_cast<float>(frame));
        commands.submit();
        frames.push_back(work_of(commands));
    }
    return frames;
}

// [stir]
// The whole pond turns about its middle, the faster the nearer to it.
vec3 stirred(vec3 place, float time) {
    const float angle = time / (0.5f + place.x * place.x + place.z * place.z);
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * place.x - s * place.z, place.y, s * place.x + c * place.z};
}

// Leaves on the water: its triangles, each with vertices of its own.
Mesh make_leaves() {
    const Mesh water = make_water();
    Mesh leaves;
    leaves.name = "leaves";
    for (const uvec3& triangle : water.triangles) {
        const uint first = static_cast<uint>(leaves.positions.size());
        for (const uint corner : {triangle.x, triangle.y, triangle.z})
            leaves.positions.push_back(water.positions[corner]);
        leaves.triangles.push_back({first, first + 1, first + 2});
    }
    return leaves;
}

// Water is stretched where it is stirred, leaves are carried and keep their shape.
std::vector<vec3> stirred_water(const Mesh& water, float time) {
    std::vector<vec3> positions;
    for (const vec3& p : water.positions) positions.push_back(stirred(p, time));
    return positions;
}

std::vector<vec3> stirred_leaves(const Mesh& leaves, float time) {
    std::vector<vec3> positions;
    for (std::size_t i = 0; i < leaves.positions.size(); ++i) {
        const vec3 stem = leaves.positions[i / 3 * 3];
        positions.push_back(stirred(stem, time) + (leaves.positions[i] - stem));
    }
    return positions;
}
// [/stir]

using StirredMesh = std::vector<vec3> (*)(const Mesh&, float);

// [cost]
// Returns the cost of the tree after each of 13 frames.
std::vector<double> costs(Context& context, const Mesh& mesh, StirredMesh stirred_mesh, double rebuild_ratio) {
    SwTlas accel(context);
    accel.set_rebuild_ratio(rebuild_ratio);
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    std::vector<double> costs;
    for (int frame = 0; frame <= 12; ++frame) {
        accel.update_vertices(handle, stirred_mesh(mesh, 0.5f * static_cast<float>(frame)));
        accel.sync();
        costs.push_back(accel.sah(handle).value());  // waits, so that the next sync knows it
    }
    return costs;
}
// [/cost]

// The costs of one mesh in the last frame: refitted only, by default, and of a tree that is built there.
struct Costs {
    std::vector<double> refitted, by_default;
    double built = 0;
};

Costs print_costs(Context& context, const std::string& name, const Mesh& mesh, StirredMesh stirred_mesh) {
    Mesh last = mesh;
    last.positions = stirred_mesh(mesh, 6);
    const StirredMesh stays = [](const Mesh& still, float) { return still.positions; };
    const Costs found{costs(context, mesh, stirred_mesh, INFINITY), costs(context, mesh, stirred_mesh, 1.5),
                      costs(context, last, stays, INFINITY).back()};
    for (std::size_t frame = 0; frame <= 12; frame += 3)
        std::cout << "2: " << name << ", frame " << frame << ": cost " << found.refitted[frame] << " by refits, "
                  << found.by_default[frame] << " with rebuilds\n";
    std::cout << "2: " << name << ", a new tree over frame 12: cost " << found.built << '\n';
    return found;
}

// [exercise3]
// Both accelerators, the same frame: how many pixels differ?
std::size_t differing_pixels(Context& context) {
    SwTlas software(context, {.keeps_surfaces = true});
    HwTlas hardware(context, BuildOrder::automatic, {.keeps_surfaces = true});
    std::vector<std::vector<Rgb>> pictures;
    for (AbstractAccel* accel : {static_cast<AbstractAccel*>(&software), static_cast<AbstractAccel*>(&hardware)}) {
        Pond pond(*accel);
        Commands commands(context, "frame");
        pond.move(commands, 1.5f);
        commands.submit();
        pictures.push_back(pond.picture(320, 280));
    }
    std::size_t differing = 0;
    for (std::size_t i = 0; i < pictures[0].size(); ++i) differing += pictures[0][i] != pictures[1][i];
    return differing;
}
// [/exercise3]

int main() try {
    Context context;
    SwTlas accel(context, {.keeps_surfaces = true});
    Pond pond(accel);
    const std::vector<Work> frames = work_of_frames(pond, context);
    for (std::size_t i = 0; i < frames.size(); ++i)
        std::cout << "1: frame " << i << ": kernels " << frames[i].kernels_ms << " ms, sync " << frames[i].sync_ms
                  << " ms in " << frames[i].sync_passes << " passes\n";
    if (frames[0].sync_passes > 0 && frames[0].sync_passes <= frames[3].sync_passes)
        throw Error("a refit takes as many passes as a build");
    const Costs water = print_costs(context, "water", make_water(), stirred_water);
    const Costs leaves = print_costs(context, "leaves", make_leaves(), stirred_leaves);
    if (!(leaves.refitted.back() > 1.5 * leaves.by_default.back() && water.refitted.back() > 1.5 * water.built))
        throw Error("rebuilds did not make the trees better");
    if (!(water.built > 1.5 * water.refitted.front() && leaves.built < leaves.refitted.front()))
        throw Error("the triangles are not what was said of them");
    if (!context.properties().ray_query) return 0;
    const std::size_t differing = differing_pixels(context);
    std::cout << "3: " << differing << " of 89600 pixels differ\n";
    if (differing > 100) throw Error("the accelerators show different pictures");
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
