// SPDX-License-Identifier: MIT
// Solutions of the exercises of tutorial 3. Exits with 1 unless each gives the known result. With --speed: prints how
// many paths per second each way traces.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string_view>

#include "tracers.h"

using namespace twinray;

namespace {

// [floor]
// A square lamp of side 1 and radiance 1 at height 1 above a floor that reflects half.
Room lamp_above_floor() {
    const vec3 eye(2, 0.5f, 0);
    return {.looks = {{vec3(0.5f), DIFFUSE}, {vec3(0), LAMP}},
            .lamp = {{-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, vec3(1)},
            .eye = {eye, vec3(0), vec3(0), -eye}};  // all pixels see the floor below the middle of the lamp
}

void push_lamp_and_floor(AbstractAccel& accel, const Room& room) {
    accel.push(make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), {}, {.custom_index = 0, .mask = SOLID_MASK});
    accel.push(make_quad(room.lamp.corner, room.lamp.u, room.lamp.v), {}, {.custom_index = 1, .mask = LAMP_MASK});
}

// Half of the part of the light that leaves that point of the floor, by Lambert's law, which would meet the lamp.
double radiance_by_formula() {
    const double a = 0.5 / std::sqrt(1.25);
    return 0.5 * 4 * a * std::atan(a) / std::numbers::pi;
}
// [/floor]

void check_floor(Context& context, const AccelOptions& options) {
    const Room room = lamp_above_floor();
    SwTlas accel(context, options);
    push_lamp_and_floor(accel, room);
    const Trace trace = [&](const Job& job) { return trace_by_batches(accel, room, job); };
    const Estimate found = mean_radiance(trace, 0), known{radiance_by_formula(), 0};
    std::cout << "1: radiance " << found.mean << " +- " << found.error << ", by the formula " << known.mean << '\n';
    if (!(standard_errors_between(found, known) <= 4)) throw Error("the light of the lamp is wrong");
}

// [roulette]
// Paths that begin with a large weight survive nearly every roulette. Their light is divided by it again.
struct Roulette {
    Estimate radiance;
    double rays;  // a path
};
Roulette trace_with_weight(AbstractAccel& accel, const Room& room, float weight, uint first_sample) {
    std::size_t rays = 0, paths = 0;
    const Estimate radiance = mean_radiance(
        [&](const Job& job) {
            Picture picture(std::size_t(job.width) * job.height, vec3(0));
            Queue queue = first_rays(room, job);
            for (Path& path : queue.paths) path.weight = vec3(weight);
            paths += queue.paths.size();
            for (; !queue.rays.empty(); queue = bounce(accel, room, queue, picture)) rays += queue.rays.size();
            for (vec3& of_pixel : picture) of_pixel /= weight;
            return picture;
        },
        first_sample);
    return {radiance, double(rays) / double(paths)};
}
// [/roulette]

void check_roulette(AbstractAccel& accel, const Room& room) {
    const Roulette with = trace_with_weight(accel, room, 1, 0), without = trace_with_weight(accel, room, 1000, 100);
    for (const Roulette& found : {with, without})
        std::cout << "2: radiance " << found.radiance.mean << " +- " << found.radiance.error << " by " << found.rays
                  << " rays a path\n";
    if (!(standard_errors_between(with.radiance, without.radiance) <= 4)) throw Error("the roulette changes the mean");
}

void check_queues(AbstractAccel& accel, const Room& room) {
    PathKernel kernel(accel, room);
    PathWaves waves(accel, room);
    const Job job{.width = 256, .height = 256, .first_sample = 0, .samples = 4};
    const std::size_t differing = differing_pixels(waves.trace(job), kernel.trace(job));
    std::cout << "3: " << differing << " of 65536 pixels differ\n";
    if (differing > 100) throw Error("the queues on the device trace other paths");
}

double seconds_of(const Trace& trace, const Job& job) {
    const auto start = std::chrono::steady_clock::now();
    trace(job);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_speeds(AbstractAccel& accel, const Room& room, const Job& job) {
    push_room(accel, room);
    PathKernel kernel(accel, room);
    PathWaves waves(accel, room);
    const std::pair<const char*, Trace> ways[] = {
        {"batches", [&](const Job& of) { return trace_by_batches(accel, room, of); }},
        {"queues on the device", [&](const Job& of) { return waves.trace(of); }},
        {"kernel", [&](const Job& of) { return kernel.trace(of); }}};
    std::vector<double> seconds[3];
    for (int round = 0; round < 8; ++round)  // they take turns; in the first round programs are compiled
        for (std::size_t way = 0; way < 3; ++way) {
            const double taken = seconds_of(ways[way].second, job);
            if (round > 0) seconds[way].push_back(taken);
        }
    for (std::size_t way = 0; way < 3; ++way) {
        std::ranges::nth_element(seconds[way], seconds[way].begin() + 3);
        std::cout << accel.name() << ", " << job.width << " x " << job.height << " x " << job.samples << " paths, by "
                  << ways[way].first << ": " << job.width * job.height * job.samples / seconds[way][3] << " a second\n";
    }
}

}  // namespace

int main(int argc, char** argv) try {
    Context context;
    const AccelOptions options{.keeps_surfaces = true};
    const Room room = make_room(1);
    if (argc > 1 && std::string_view(argv[1]) == "--speed") {
        for (const Job& job : {Job{256, 256, 0, 4}, Job{64, 64, 0, 1}}) {
            SwTlas software(context, options);
            print_speeds(software, room, job);
            HwTlas hardware(context, BuildOrder::automatic, options);
            print_speeds(hardware, room, job);
        }
        return 0;
    }
    check_floor(context, options);
    SwTlas accel(context, options);
    push_room(accel, room);
    check_roulette(accel, room);
    check_queues(accel, room);
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
