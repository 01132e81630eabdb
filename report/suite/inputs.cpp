// Invalid and special input: rays, and meshes in device memory. Meshes and wrong use are in inputs_scene.cpp.
#include "report/suite/sections.h"

#include <array>
#include <utility>

#include <glm/gtc/packing.hpp>
#include <twinray/device_mesh.h>
#include "engine/core/commands.h"

namespace twinray::suite {
namespace {

// Returns rays that hit and miss a sphere. `spoil(ray, i)` makes every second one special: it lies in one subgroup with
// rays that must not notice.
template <class Spoil>
std::vector<Ray> every_second(const Mesh& mesh, std::size_t count, std::uint64_t seed, const Spoil& spoil) {
    std::vector<Ray> rays = random_rays(bounds_of(mesh), count, seed);
    for (std::size_t i = 1; i < count; i += 2) spoil(rays[i], i / 2);
    return rays;
}

template <class Spoil>
void measure_every_second(CaseRun& run, std::size_t least, const Spoil& spoil) {
    const Mesh sphere = make_icosphere(4);
    run.measure(world_of(sphere), every_second(sphere, run.amount(least, 1'000'000), run.seed(), spoil));
}

void spoil_component(Ray& ray, std::size_t i) {
    constexpr float bad[] = {nan, inf, -inf};
    (i % 6 < 3 ? ray.origin : ray.direction)[static_cast<int>(i % 3)] = bad[i / 6 % 3];
}

// Times NaN, infinite and zero rays alone, against as many normal ones: they must not stall a device.
void time_of_bad_rays(CaseRun& run) {
    constexpr double limit = 2.5;
    const Mesh sphere = make_icosphere(5);
    const World world = world_of(sphere);
    const std::vector<Ray> normal = random_rays(bounds_of(sphere), run.amount(8'192, 1'000'000), run.seed());
    std::vector<Ray> bad = normal;
    for (std::size_t i = 0; i < bad.size(); ++i) spoil_component(bad[i], i);
    const std::vector<Configuration> configurations = run.configurations();
    const std::size_t reps = run.amount(3, 15);
    const std::vector<Traced> normals = trace(run.devices(), configurations, world, {.rays = normal, .reps = reps});
    const std::vector<Traced> bads = trace(run.devices(), configurations, world, {.rays = bad, .reps = reps});
    for (std::size_t i = 0; i < configurations.size(); ++i) {
        const double ratio = median(bads[i].ns_per_ray) / median(normals[i].ns_per_ray);
        run.expect(configurations[i],
                   {.params = {{"measured", "time"}},
                    .results = {{"time_ratio", ratio}},
                    .faults = ratio > limit ? 1u : 0u,
                    .what = text("bad rays take ", ratio, " times as long as normal ones; at most ", limit)});
    }
}

void bad_rays(CaseRun& run) {
    measure_every_second(run, 4'096, spoil_component);
    time_of_bad_rays(run);
}

void intervals(CaseRun& run) {
    const auto spoil = [](Ray& ray, std::size_t i) {
        constexpr std::array<std::array<float, 2>, 12> ends = {{{2, 1},
                                                                {1, 1},
                                                                {-1, inf},
                                                                {-3, -1},
                                                                {nan, inf},
                                                                {0, nan},
                                                                {nan, nan},
                                                                {0, 0},
                                                                {-0.0f, inf},
                                                                {inf, inf},
                                                                {-inf, inf},
                                                                {0, -inf}}};
        ray.t_min = ends[i % ends.size()][0];
        ray.t_max = ends[i % ends.size()][1];
    };
    measure_every_second(run, 8'192, spoil);
}

void zero_directions(CaseRun& run) {
    measure_every_second(run, 8'192, [](Ray& ray, std::size_t i) {
        for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = i >> axis & 1 ? -0.0f : 0.0f;
    });
}

// Puts NaN, 1e38 and denormal numbers into origins and directions, which also affects the order of the rays.
void extreme_rays_in_order(CaseRun& run) {
    const Mesh sphere = make_icosphere(4);
    constexpr std::array numbers = {nan, inf, -inf, 1e38f, -1e38f, 1e-40f, -0.0f};
    const std::vector<Ray> rays =
        every_second(sphere, run.amount(4'096, 1'000'000), run.seed(), [&](Ray& ray, std::size_t i) {
            (i % 2 ? ray.origin : ray.direction)[static_cast<int>(i / 2 % 3)] = numbers[i / 6 % numbers.size()];
        });
    for (const Configuration& configuration : run.configurations()) {
        AbstractAccel& accel = run.devices().empty_accel(configuration);
        accel.push(sphere);
        const std::vector<Hit> given = accel.closest_hits(rays, {.level = configuration.level}),
                               sorted =
                                   accel.closest_hits(rays, {.level = configuration.level, .order = RayOrder::sorted});
        expect_same_bits(run, configuration, rays, given, sorted, {.what = "differs: "});
    }
}

struct EndedRay {
    Ray ray;
    bool hits;
};

// Returns rays straight down onto z = 0 from heights that are exact in float32, so that t is also exact.
std::vector<EndedRay> rays_that_end_at_the_hit() {
    std::vector<EndedRay> rays;
    for (const float height : {0x1p-20f, 0.375f, 1.0f, 4.0f, 1000.0f, 0x1p20f})
        for (const float speed : {1.0f, 0.5f, 4.0f}) {
            const float t = height / speed;
            const auto add = [&](float t_min, float t_max, bool hits) {
                rays.push_back({{vec3(0.3f, 0.4f, height), t_min, vec3(0, 0, -speed), t_max}, hits});
            };
            add(t, inf, false);
            add(0, t, false);
            add(t, t, false);
            add(std::nextafter(t, 0.0f), inf, true);
            add(0, std::nextafter(t, inf), true);
            add(std::nextafter(t, 0.0f), std::nextafter(t, inf), true);
            add(std::nextafter(t, inf), inf, false);
            add(0, std::nextafter(t, 0.0f), false);
        }
    return rays;
}

void ends_at_the_hit(CaseRun& run) {
    const World world = world_of(make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)));
    const std::vector<EndedRay> ended = rays_that_end_at_the_hit();
    std::vector<Ray> rays;
    for (const EndedRay& one : ended) rays.push_back(one.ray);
    for (const Query query : {Query::closest, Query::any})
        for (const Traced& traced : run.trace(world, rays, query)) {
            CaseRun::Outcome outcome{.params = {{"query", query == Query::any ? "any" : "closest"}}, .n = rays.size()};
            for (std::size_t i = 0; i < rays.size(); ++i)
                if ((traced.hits[i].hit != 0) != ended[i].hits && outcome.faults++ == 0)
                    outcome.what = (ended[i].hits ? "missed " : "hit ") + hexadecimal(rays[i]);
            run.expect(traced.configuration, outcome);
        }
}

// ---- Meshes in device memory, in each format, with coordinates that are not finite and indices out of range.

// A sphere as a kernel has written it, and as it must be read: a triangle that must not count has a vertex that is NaN.
struct Written {
    VertexFormat format;
    std::vector<float> wide;            // of float32
    std::vector<std::uint16_t> narrow;  // of the others
    std::vector<uvec3> triangles;
    uint count;  // of triangles, in device memory
    Mesh read;
};

// Makes a sphere of numbers that each format but snorm16 has exactly.
Mesh coarse_sphere() {
    Mesh sphere = make_icosphere(3);
    for (vec3& position : sphere.positions) position = round(position * 256.0f) / 256.0f;
    return sphere;
}

void write(Written& written, float number) {
    if (written.format == VertexFormat::float32) written.wide.push_back(number);
    if (written.format == VertexFormat::float16) written.narrow.push_back(glm::packHalf1x16(number));
    if (written.format == VertexFormat::snorm16) written.narrow.push_back(glm::packSnorm1x16(number));
}

float read(const Written& written, std::size_t i) {
    if (written.format == VertexFormat::float32) return written.wide[i];
    if (written.format == VertexFormat::float16) return glm::unpackHalf1x16(written.narrow[i]);
    return static_cast<float>(static_cast<std::int16_t>(written.narrow[i]) / 32767.0);
}

Written written_sphere(VertexFormat format) {
    const Mesh sphere = coarse_sphere();
    Written written{format, {}, {}, sphere.triangles, static_cast<uint>(sphere.triangles.size() - 100), {}};
    for (const vec3& p : sphere.positions)
        for (int axis = 0; axis < 3; ++axis) write(written, p[axis]);
    const std::array<float, 3> bad = {inf, -inf, nan};
    if (format != VertexFormat::snorm16)  // which has no such numbers
        for (std::size_t i = 0; i < bad.size(); ++i) {
            Written number{format, {}, {}, {}, 0, {}};
            write(number, bad[i]);
            const std::size_t at = 3 * (100 + 7 * i) + i;
            if (number.narrow.empty())
                written.wide[at] = number.wide[0];
            else
                written.narrow[at] = number.narrow[0];
        }
    const auto none = static_cast<uint>(sphere.positions.size());
    written.triangles[10].y = none;
    written.triangles[20].z = 0xffffffffu;
    for (std::size_t i = 0; i < sphere.positions.size(); ++i)
        written.read.positions.push_back({read(written, 3 * i), read(written, 3 * i + 1), read(written, 3 * i + 2)});
    written.read.positions.push_back(vec3(nan));
    written.read.triangles = sphere.triangles;
    for (std::size_t i = 0; i < sphere.triangles.size(); ++i)
        if (i == 10 || i == 20 || i >= written.count) written.read.triangles[i] = uvec3(none);
    return written;
}

// Pushes the mesh and keeps its buffers in `buffers`.
void push(AbstractAccel& accel, const Written& written, std::vector<Buffer>& buffers) {
    const auto keep = [&](const auto& values) -> Buffer& {
        return buffers.emplace_back(uploaded(accel.context(), "written mesh", std::span(values)));
    };
    const bool is_wide = written.format == VertexFormat::float32;
    DeviceMesh mesh{.name = "written sphere",
                    .positions = (is_wide ? keep(written.wide) : keep(written.narrow)).address(),
                    .stride = 3 * component_bytes(written.format),
                    .format = written.format,
                    .vertex_count = written.read.positions.size() - 1,
                    .triangle_count = written.triangles.size()};
    mesh.indices = keep(written.triangles).address();
    mesh.count_on_device = keep(std::vector{written.count}).ref<uint>();
    accel.push(mesh);
}

void device_meshes(CaseRun& run) {
    for (const auto& [name, format] : {std::pair{"float32", VertexFormat::float32},
                                       {"float16", VertexFormat::float16},
                                       {"snorm16", VertexFormat::snorm16}}) {
        const Written written = written_sphere(format);
        std::vector<Buffer> buffers;  // until all have traced
        const World world{[&](AbstractAccel& accel) { push(accel, written, buffers); },
                          world_of(written.read).reference};
        const std::vector<Ray> rays = mixed_rays(world, {vec3(-1), vec3(1)}, run.amount(2'048, 500'000), run.seed());
        run.measure(world, rays, {.params = {{"format", name}}, .fast_is_control = true, .reps = 1});
    }
}

}  // namespace

std::vector<SuiteCase> input_cases() {
    return {
        {"N01", "NaN in x of one vertex of many", "hits of the other triangles, and their indices",
         "0 SW_LEAK, SW_FALSE, T_ERR: only its triangles are inactive", vertex_not_a_number_in_x},
        {"N02", "NaN in y or z of one vertex", "the same, and the warning",
         "as N01, and the warning counts the triangles", vertex_not_a_number_in_y_or_z},
        {"N03", "infinite vertex", "the same", "as N02; the rest of its mesh is unaffected", infinite_vertex},
        {"N04",
         "NaN and infinity in every second ray's origin or direction; then in all, against the time of normal rays",
         "hits of bad rays, errors of their neighbours, time",
         "no bad ray hits, 0 faults in the others, at most 2.5 times the time", bad_rays},
        {"N05", "t_min > t_max, equal, negative, NaN or infinite in every second ray", "hits",
         "empty and NaN intervals miss, a negative t_min counts as 0", intervals},
        {"N06", "zero direction, of both signs, in every second ray", "hits",
         "zero directions miss, the others are right", zero_directions},
        {"N07", "hits at exactly t_min or t_max, and one float beside", "hits", "both ends are exclusive",
         ends_at_the_hit},
        {"N08", "index out of range, lengths that do not match, misaligned addresses, stale views, dead handles",
         "errors", "each is refused by an Error that names the object and the value", wrong_use},
        {"N09", "0, 1 and 2 triangles; no instance; an empty mesh among others", "hits", "valid; 0 faults",
         empty_and_small},
        {"N10", "2^25 triangles or boxes in one geometry; 2^24 instances in the full suite", "errors",
         "each is refused by an Error that names the limit, 2^25 - 1 or 2^24 - 1", too_many},
        {"N11", "a buffer of 2^44 bytes; two planes, in the full suite of more than 4 GiB of trees", "errors, hits",
         "an Error that names the size and changes nothing; the planes' hits are those of their squares",
         large_buffers},
        {"N12", "masks, cull flags, mirrored, turned and uncullable instances: all combinations, seen from both sides",
         "hits", "equal to the reference's", masks_and_culling},
        {"N13", "context, build and trace while one call of Vulkan fails, or the device is lost from then on",
         "errors, hits, leaks", "an Error, nothing left alive, and the right hits from the next try", failing_calls},
        {"N14", "sorted rays, every second with NaN, infinity, 1e38 or a denormal number in it",
         "hits that differ in a bit from those of rays in the given order", "0", extreme_rays_in_order},
        {"N15",
         "meshes in device memory, in each format: coordinates that are not finite, indices out of range, the count "
         "there",
         "hits of the other triangles", "0 SW_LEAK, SW_FALSE, T_ERR", device_meshes},
    };
}

}  // namespace twinray::suite
