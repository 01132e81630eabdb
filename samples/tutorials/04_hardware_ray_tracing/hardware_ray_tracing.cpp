// SPDX-License-Identifier: MIT
// The same rays in software, by ray queries and by a ray tracing pipeline: hardware_ray_tracing FOLDER
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include <twinray/scene.h>
#include <twinray/validation.h>
#include "twinray/glsl/cpp.h"

#include "cage.trace_program.h"
#include "cage_picture_hw.spv.h"
#include "cage_picture_sw.spv.h"
#include "ways.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "cage.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

constexpr uint picture_size = 320;

// [ask]
// Returns rays from the eye to each vertex of the ball, where up to six triangles meet.
std::vector<Ray> rays_at_vertices(const Mesh& ball) {
    std::vector<Ray> rays;
    for (const vec3& vertex : ball.positions)
        rays.push_back({.origin = eye(), .t_min = 0, .direction = vertex - eye(), .t_max = INFINITY});
    return rays;
}

// The answers of a way, and the float64 verdict on each.
struct Answers {
    std::vector<Hit> hits;
    std::vector<HitClass> classes;
};

Answers ask(const Way& way, const Mesh& ball, const Reference& reference, std::span<const Ray> rays) {
    const std::unique_ptr<AbstractAccel> accel = way.make_accel();
    accel->push(ball);
    Answers answers{accel->closest_hits(rays), {}};
    answers.classes = reference.classify(rays, answers.hits, way.is_software ? TracedBy::software : TracedBy::hardware);
    return answers;
}
// [/ask]

void print_row(const Way& way, const Answers& answers, const Answers& of_software) {
    const HitClassCounts counts = count(answers.classes);
    const auto lost = counts[HitClass::sw_leak] + counts[HitClass::hw_leak];
    const auto wrong = counts.faults_of_ours() + counts.faults_of_hardware() - lost;
    std::size_t other_triangle = 0, other_t = 0;
    for (std::size_t i = 0; i < answers.hits.size(); ++i) {
        const Hit &hit = answers.hits[i], &theirs = of_software.hits[i];
        if (!hit.hit || !theirs.hit) continue;
        if (hit.primitive_index != theirs.primitive_index)
            ++other_triangle;
        else
            other_t += hit.t != theirs.t;
    }
    const auto right = counts[HitClass::agree] + counts[HitClass::tie];
    std::cout << "  " << std::left << std::setw(18) << way.name << std::right;
    for (const auto number : {right, counts.total() - right - lost - wrong, lost, wrong, other_triangle, other_t})
        std::cout << std::setw(10) << number;
    std::cout << '\n';
}

// [map]
// Draws for each pixel the ball where SwTlas hits it, coloured by the way's answer to the ray at the nearest vertex.
std::vector<Rgb> map_of_vertices(const Way& software, const Mesh& ball, const Answers& answers,
                                 const Answers& of_software, uint size) {
    std::vector<Ray> rays;
    for (uint pixel = 0; pixel < size * size; ++pixel) rays.push_back(camera_ray(pixel, size, 0.29f));
    const std::unique_ptr<AbstractAccel> accel = software.make_accel();
    accel->push(ball);
    std::vector<Rgb> map;
    for (const Hit& hit : accel->closest_hits(rays)) {
        if (!hit.hit) {
            map.push_back({255, 255, 255});
            continue;
        }
        const uvec3 corners = ball.triangles[hit.primitive_index];
        const float rest = 1 - hit.u - hit.v;
        const uint vertex = hit.u > std::max(hit.v, rest) ? corners.y : hit.v > rest ? corners.z : corners.x;
        const bool is_lost = answers.classes[vertex] == HitClass::hw_leak;
        const bool is_same = answers.hits[vertex].primitive_index == of_software.hits[vertex].primitive_index;
        const vec3 color = is_lost ? vec3(0.8f, 0.02f, 0.02f) : is_same ? vec3(0.75f) : vec3(0.25f, 0.45f, 0.75f);
        map.push_back(rgb_of_linear(color * (0.4f + 0.6f * std::max(0.0f, dot(ball.positions[vertex], to_sun())))));
    }
    return map;
}

// [order]
std::size_t differing(std::span<const Hit> a, std::span<const Hit> b) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        differing += a[i].hit != b[i].hit || a[i].t != b[i].t || a[i].primitive_index != b[i].primitive_index;
    return differing;
}

// Uses the same mesh, the same rays, the same device; only the tree is another one.
std::size_t differing_by_tree(const Way& way, const Mesh& ball, std::span<const Ray> rays) {
    std::unique_ptr<AbstractAccel> one, other;
    if (way.is_software) {
        one = std::make_unique<SwTlas>(*way.context, AccelOptions{.layout = Layout::compressed4});
        other = std::make_unique<SwTlas>(*way.context, AccelOptions{.layout = Layout::bvh2});
    } else {
        one = std::make_unique<HwTlas>(*way.context, BuildOrder::morton);
        other = std::make_unique<HwTlas>(*way.context, BuildOrder::input);
    }
    one->push(ball);
    other->push(ball);
    return differing(one->closest_hits(rays), other->closest_hits(rays));
}

// [cost]
// Returns the time of some work on the device: the least of five, since the first includes work that is done once.
template <class Work>
double least_ms(Context& context, const Work& work) {
    using Clock = std::chrono::steady_clock;
    double least = INFINITY;
    for (int i = 0; i < 5; ++i) {
        const Clock::time_point start = Clock::now();
        work();
        context.wait_for_gpu();
        const std::chrono::duration<double, std::milli> took = Clock::now() - start;
        least = std::min(least, took.count());
    }
    return least;
}

void print_cost(const Way& way, const Mesh& ball, std::span<const Ray> rays) {
    const std::unique_ptr<AbstractAccel> accel = way.make_accel();
    const AccelHandle handle = accel->push(ball);
    const double scratch = double(accel->memory_requirements().scratch);
    const double build_ms = least_ms(*way.context, [&] {
        accel->update(handle, ball);  // another mesh, so that the tree is built anew
        accel->sync();
    });
    const double kept = double(accel->memory_usage().structures());
    const double refit_ms = least_ms(*way.context, [&] {
        accel->update_vertices(handle, ball.positions);
        accel->sync();
    });
    const Buffer on_device(*way.context, {.name = "rays", .bytes = rays.size_bytes()});
    const Buffer hits(*way.context, {.name = "hits", .bytes = rays.size() * sizeof(Hit)});
    Commands upload(*way.context, "upload");
    {
        const auto pass = upload.pass("rays");
        upload.upload(on_device, rays);
    }
    upload.submit();
    const double trace_ms = least_ms(*way.context, [&] {
        Commands commands(*way.context, "trace");
        accel->trace(commands, accel->view(), {on_device.ref<Ray>(), hits.ref<Hit>(), rays.size()});
        commands.submit();
    });
    std::cout << "  " << std::left << std::setw(18) << way.name << std::right << std::fixed << std::setprecision(1);
    for (const double number : {double(rays.size()) / trace_ms / 1000, build_ms, refit_ms,
                                kept / double(ball.triangles.size()), scratch / 1024})
        std::cout << std::setw(10) << number;
    std::cout << '\n';
}
// [/cost]

// Writes pictures side by side, with a gap between two; grey if one is empty.
void write_strip(const std::filesystem::path& file, std::span<const std::vector<Rgb>> pictures, uint size) {
    const uint gap = 6, width = static_cast<uint>(pictures.size()) * (size + gap) - gap;
    std::vector<Rgb> strip(std::size_t{width} * size, {255, 255, 255});
    for (uint i = 0; i < pictures.size(); ++i)
        for (uint y = 0; y < size; ++y) {
            const auto row = strip.begin() + y * width + i * (size + gap);
            if (pictures[i].empty())
                std::fill_n(row, size, Rgb{225, 225, 225});
            else
                std::copy_n(pictures[i].begin() + y * size, size, row);
        }
    write_png(file, width, size, strip);
}

// Colours of host and device may be rounded one apart.
std::size_t differing_pixels(std::span<const Rgb> a, std::span<const Rgb> b) {
    const auto apart = [](std::uint8_t x, std::uint8_t y) { return std::abs(int(x) - int(y)) > 1; };
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        differing += apart(a[i].r, b[i].r) || apart(a[i].g, b[i].g) || apart(a[i].b, b[i].b);
    return differing;
}

// [batches]
void push_cage(AbstractAccel& accel) {
    accel.push(make_quad({-30, -1, 30}, {60, 0, 0}, {0, 0, -60}), {}, {.custom_index = FLOOR, .mask = 1 << FLOOR});
    accel.push(make_icosphere(2), {}, {.custom_index = CAGE, .mask = 1 << CAGE, .non_opaque = true});
    const Bounds box{vec3(-BALL_RADIUS), vec3(BALL_RADIUS)};
    accel.push(BoxesView{"ball", {&box, 1}}, {}, {.custom_index = BALL, .mask = 1 << BALL});
    accel.sync();
}

std::vector<Rgb> picture_by_batches(AbstractAccel& accel, uint size) {
    const std::unique_ptr<TraceProgram> program = accel.make_program(cage);
    std::vector<Ray> rays, to_light;
    for (uint pixel = 0; pixel < size * size; ++pixel) rays.push_back(camera_ray(pixel, size, 0.42f));
    const std::vector<Hit> hits = accel.closest_hits(rays, {.program = program.get()});
    for (std::size_t i = 0; i < rays.size(); ++i) to_light.push_back(ray_to_sun(rays[i], hits[i]));
    const std::vector<Hit> shadows = accel.any_hits(to_light, {.mask = IN_THE_WAY_OF_LIGHT, .program = program.get()});
    std::vector<Rgb> picture;
    const auto byte = [](float linear) { return std::uint8_t(255 * std::sqrt(std::min(linear, 1.0f)) + 0.5f); };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const vec3 color = color_of(rays[i], hits[i], shadows[i].hit == 0);
        picture.push_back({byte(color.x), byte(color.y), byte(color.z)});
    }
    return picture;
}

// [kernel]
std::vector<Rgb> picture_by_kernel(AbstractAccel& accel, uint size) {
    Context& context = accel.context();
    QueryKernel<PictureArgs> kernel(accel, {.name = "cage picture"}, cage_picture_sw_spirv, cage_picture_hw_spirv);
    const Buffer pixels(context, {.name = "pixels", .bytes = size * size * sizeof(uint)});
    Commands commands(context, "picture");
    kernel.dispatch(commands, {accel.view().scene, pixels.ref<uint>(), size}, size * size);
    commands.submit();
    std::vector<Rgb> picture;
    for (const uint pixel : download<uint>(context, pixels, size * size))
        picture.push_back({std::uint8_t(pixel), std::uint8_t(pixel >> 8), std::uint8_t(pixel >> 16)});
    return picture;
}
// [/kernel]

// Renders by batches and, if kernels can trace, also by a kernel. Each is compared with `first`, if there is one.
std::vector<Rgb> picture_of_cage(const Way& way, const std::vector<Rgb>& first) {
    const std::unique_ptr<AbstractAccel> accel = way.make_accel();
    push_cage(*accel);
    const std::vector<Rgb> picture = picture_by_batches(*accel, picture_size);
    const auto compare = [&](const char* by, const std::vector<Rgb>& one, const std::vector<Rgb>& other) {
        const std::size_t differing = differing_pixels(one, other);
        std::cout << "cage by " << way.name << by << differing << " of " << one.size() << " pixels differ\n";
        if (differing > picture_size) throw Error("the pictures differ");
    };
    if (!first.empty()) compare(", batches: ", picture, first);
    if (accel->capability(Feature::kernel_queries).support == Support::native)
        compare(", a kernel: ", picture_by_kernel(*accel, picture_size), picture);
    return picture;
}

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: hardware_ray_tracing FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const std::vector<Way> ways = ways_of_device();
    for (const Way& way : ways) print_lacking(way);
    const AccelChoice choice = choose_accel(ways.front().context->properties(), "auto", {.kernel_queries = true});
    std::cout << "of both, choose_accel takes " << name_of(choice) << ": " << choice.why << '\n';

    // [compare]
    const Mesh ball = make_icosphere(5);
    const MeshView view(ball);
    const Reference reference({&view, 1}, std::array{ReferenceInstance{}});
    const std::vector<Ray> random = random_rays({vec3(-1), vec3(1)}, 100'000, 1), aimed = rays_at_vertices(ball);
    std::vector<Answers> of_aimed;
    for (const auto& [name, rays] : {std::pair{" rays at random", &random}, {" rays at vertices", &aimed}}) {
        std::cout << std::setw(6) << rays->size() << std::left << std::setw(19) << name << std::right
                  << "right  rounding      lost     wrong  triangle         t\n";
        of_aimed.clear();
        for (const Way& way : ways) {
            of_aimed.push_back(ask(way, ball, reference, *rays));
            print_row(way, of_aimed.back(), of_aimed.front());
        }
    }
    // [/compare]
    if (count(of_aimed.front().classes).faults_of_ours() > 0) throw Error("SwTlas is wrong");

    for (const Way& way : ways) {
        const std::size_t other = differing_by_tree(way, ball, aimed);
        std::cout << "another tree: " << other << " answers of " << way.name << " change\n";
        if (way.is_software && other > 0) throw Error("SwTlas depends on its tree");
    }

    std::vector<Ray> seen;
    for (uint pixel = 0; pixel < 512 * 512; ++pixel) seen.push_back(camera_ray(pixel, 512, 0.29f));
    std::cout << "on this machine        Mrays/s  build ms  refit ms  bytes/tri   scratch KiB\n";
    for (const Way& way : ways) print_cost(way, ball, seen);

    std::vector<std::vector<Rgb>> pictures;
    for (const Way& way : ways)
        pictures.push_back(picture_of_cage(way, pictures.empty() ? std::vector<Rgb>() : pictures.front()));
    pictures.resize(3);
    pictures.push_back(map_of_vertices(ways.front(), ball, of_aimed.back(), of_aimed.front(), picture_size));
    write_strip(folder / "04_hardware_ray_tracing.png", pictures, picture_size);
    std::cout << "wrote 04_hardware_ray_tracing.png\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
