// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <algorithm>
#include <iostream>

#include "scene.h"

// [exercise1]
// What a frame costs on the device: the kernels, and what the sync adds.
void print_times(Context& context, Pond& pond) {
    Commands commands(context, "frame");
    pond.move(commands, 0.3f);
    commands.submit();
    for (const PassTiming& pass : commands.timings()) std::cout << "1: " << pass.name << ' ' << pass.ms << " ms\n";
}
// [/exercise1]

// [exercise2]
// How much worse a tree gets when its mesh is shuffled instead of waved: the surface area heuristic.
std::pair<double, double> cost_before_and_after(Context& context, double rebuild_ratio) {
    SwTlas accel(context);
    accel.set_rebuild_ratio(rebuild_ratio);
    Mesh water = make_water();
    const AccelHandle handle = accel.push(water);
    accel.sync();
    accel.update_vertices(handle, water.positions);
    accel.sync();
    const double before = accel.sah(handle).value();
    for (std::size_t i = 0; i < water.positions.size(); ++i)  // every second row to the other side
        if (i / 97 % 2 == 1) water.positions[i].x = -water.positions[i].x;
    for (int frame = 0; frame < 2; ++frame) {  // the second sync knows what the first one did
        accel.update_vertices(handle, water.positions);
        accel.sync();
        accel.wait_for_gpu();
    }
    return {before, accel.sah(handle).value()};
}
// [/exercise2]

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
    print_times(context, pond);
    const auto [before, refitted] = cost_before_and_after(context, INFINITY);
    const auto [again, rebuilt] = cost_before_and_after(context, 1.5);
    std::cout << "2: cost " << before << ", refitted " << refitted << ", with rebuilds past 1.5 times " << rebuilt
              << '\n';
    if (again != before || !(rebuilt < refitted)) throw Error("a rebuild did not make the tree better");
    if (!context.properties().ray_query) return 0;
    const std::size_t differing = differing_pixels(context);
    std::cout << "3: " << differing << " of 89600 pixels differ\n";
    if (differing > 100) throw Error("the accelerators show different pictures");
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
