// SPDX-License-Identifier: MIT
// Tutorial 3: paths of light, by batches from the host and by a kernel; both must agree, and the error must fall.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>

#include "tracers.h"

using namespace twinray;

namespace {

void print_waves(AbstractAccel& accel, const Room& room) {
    Picture picture(64 * 64);
    std::cout << "rays of each wave:";
    for (Queue queue = first_rays(room, {.width = 64, .height = 64, .first_sample = 0, .samples = 16});
         !queue.rays.empty(); queue = bounce(accel, room, queue, picture))
        std::cout << ' ' << queue.rays.size();
    std::cout << '\n';
}

// [agree]
void check_means(std::span<AbstractAccel* const> accels, const Room& room) {
    std::vector<Estimate> estimates;
    const auto add = [&](const std::string& name, const Trace& trace) {
        const uint first_sample = 100 * uint(estimates.size());  // each way has random numbers of its own
        estimates.push_back(mean_radiance(trace, first_sample));
        const double apart = standard_errors_between(estimates.front(), estimates.back());
        std::cout << name << ": mean radiance " << estimates.back().mean << " +- " << estimates.back().error << ", "
                  << apart << " standard errors from the first\n";
        if (!(apart <= 4)) throw Error(name + " disagrees");
    };
    for (AbstractAccel* accel : accels) {
        PathKernel kernel(*accel, room);
        add(accel->name() + " by batches", [&](const Job& job) { return trace_by_batches(*accel, room, job); });
        add(accel->name() + " by kernel", [&](const Job& job) { return kernel.trace(job); });
    }
}

// [same_paths]
void check_same_paths(AbstractAccel& accel, const Room& room, PathKernel& kernel) {
    const Job job{.width = 256, .height = 256, .first_sample = 0, .samples = 2};
    const std::size_t differing = differing_pixels(trace_by_batches(accel, room, job), kernel.trace(job));
    std::cout << "with the same random numbers " << differing << " of 65536 pixels differ\n";
    if (differing > 100) throw Error("batches and kernel do not trace the same paths");
}

// [error]
// Returns the root mean square error of a pixel of pictures with so many samples, from the difference of two of them.
double error_of(PathKernel& kernel, uint samples) {
    const Picture a = kernel.trace({64, 64, 0, samples}), b = kernel.trace({64, 64, samples, samples});
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += double(dot(a[i] - b[i], a[i] - b[i]));
    return std::sqrt(squares / (2 * 3 * double(a.size())));
}

void check_errors(PathKernel& kernel) {
    std::vector<double> errors;
    for (const uint samples : {1u, 4u, 16u, 64u}) {
        errors.push_back(error_of(kernel, samples));
        std::cout << samples << " samples: error " << errors.back() << '\n';
    }
    const double halvings = std::log2(errors.front() / errors.back());
    std::cout << "64 times the samples halve it " << halvings << " times\n";
    if (!(std::abs(halvings - 3) <= 0.3)) throw Error("the error does not halve with 4 times the samples");
}

// [lanes]
// Returns how many rays each path of a picture takes, without shadow rays.
std::vector<uint> lengths_of_paths(AbstractAccel& accel, const Room& room) {
    Picture picture(256 * 256);
    std::vector<uint> lengths(picture.size());
    for (Queue queue = first_rays(room, {.width = 256, .height = 256, .first_sample = 0, .samples = 1});
         !queue.rays.empty(); queue = bounce(accel, room, queue, picture))
        for (const Path& path : queue.paths) ++lengths[path.pixel];
    return lengths;
}

// The mean fraction of working lanes, if so many paths start together and wait for the longest of them.
double busy_lanes(std::span<const uint> lengths, std::size_t lanes) {
    double busy = 0, taken = 0;
    for (std::size_t first = 0; first < lengths.size(); first += lanes) {
        const auto group = lengths.subspan(first, lanes);
        for (const uint length : group) busy += length;
        taken += double(lanes) * std::ranges::max(group);
    }
    return busy / taken;
}
// [/lanes]

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    const Room room = make_room(1);
    Context context;
    SwTlas software(context, {.keeps_surfaces = true});
    std::vector<AbstractAccel*> accels = {&software};
    std::optional<HwTlas> hardware;
    if (context.properties().ray_query)  // so that kernels can trace it
        accels.push_back(&hardware.emplace(context, BuildOrder::automatic, AccelOptions{.keeps_surfaces = true}));
    for (AbstractAccel* accel : accels) push_room(*accel, room);
    print_waves(software, room);
    check_means(accels, room);
    PathKernel kernel(software, room);
    check_same_paths(software, room, kernel);
    check_errors(kernel);
    const std::vector<uint> lengths = lengths_of_paths(software, room);
    for (const std::size_t lanes : {8, 16, 32})
        std::cout << "of " << lanes << " lanes " << 100 * busy_lanes(lengths, lanes) << " % work\n";
    // [picture]
    std::vector<Rgb> pixels;
    for (const vec3& radiance : kernel.trace({.width = 256, .height = 256, .first_sample = 0, .samples = 32}))
        pixels.push_back(rgb_of_linear(radiance));
    write_png(folder / "03_wavefront_path_tracer.png", 256, 256, pixels);
    // [/picture]
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
