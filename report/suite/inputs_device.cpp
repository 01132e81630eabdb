// SPDX-License-Identifier: MIT
// Meshes in device memory, in each format, with coordinates that are not finite and indices out of range.
#include <twinray/device_mesh.h>
#include <twinray/geometry.h>

#include <array>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "engine/core/uploaded.h"
#include "report/suite/sections.h"
#include "report/suite/scenes.h"

namespace twinray::suite {
namespace {

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

}  // namespace

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

}  // namespace twinray::suite
