// SPDX-License-Identifier: MIT
// Rays that get out of a closed mesh, counted and drawn: robust_rays FOLDER
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <twinray/scene.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

#include "body.h"

using namespace twinray;

// [count]
// The body is closed and the rays begin inside: each must hit something. Those that do not have leaked.
std::vector<uint> leaked_vertices(AbstractAccel& accel, const AimedRays& aimed, Level level) {
    const std::vector<Hit> hits = accel.closest_hits(aimed.rays, {.level = level});
    std::vector<uint> leaked;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (!hits[i].hit) leaked.push_back(aimed.vertices[i]);
    return leaked;
}

// [crossings]
// A ray that loses one wall may hit the next one, so that no miss shows it. The number of crossings does: from inside
// it is odd.
LeakCounts count_crossings(Context& context, const Mesh& body, Level level) {
    SwTlas accel(context, {.level = level});
    const LeakTest test(accel, body, level, 1);
    LeakCounts counts;
    test.trace(100'000, counts);
    return counts;
}

// [picture]
// Shows the body from outside, with its edges, and a red dot where a ray got out.
class Picture {
  public:
    static constexpr uint size = 480;

    Picture(AbstractAccel& accel, const Mesh& body) : body_(body), pixels_(size * size, {246, 246, 244}) {
        std::vector<Ray> rays;
        for (uint i = 0; i < size * size; ++i)
            rays.push_back({.origin = to_world(i % size, i / size), .t_min = 0, .direction = {0, 0, -1}, .t_max = 10});
        const std::vector<Hit> hits = accel.closest_hits(rays);
        for (uint i = 0; i < hits.size(); ++i)
            if (hits[i].hit) pixels_[i] = shade(hits[i]);
    }

    void mark(std::span<const uint> vertices) {
        for (const uint vertex : vertices)
            if (body_.normals[vertex].z > 0) draw_dot(body_.positions[vertex]);
    }
    std::span<const Rgb> row(uint y) const { return std::span(pixels_).subspan(y * size, size); }

  private:
    static constexpr float reach = 1.25f;  // what is seen, from the middle to the rim

    static vec3 to_world(uint x, uint y) {
        const float pixel = 2 * reach / size;
        return {(static_cast<float>(x) + 0.5f) * pixel - reach, reach - (static_cast<float>(y) + 0.5f) * pixel, 5};
    }
    Rgb shade(const Hit& hit) const {
        const uvec3 triangle = body_.triangles[hit.primitive_index];
        const vec3 normal = normalize(body_.normals[triangle.x] * (1 - hit.u - hit.v) +
                                      body_.normals[triangle.y] * hit.u + body_.normals[triangle.z] * hit.v);
        const bool is_edge = std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < 0.05f;
        const float lit = 0.35f + 0.65f * std::max(0.0f, dot(normal, vec3(-0.4f, 0.6f, 0.7f)));
        return rgb_of_linear(vec3(0.28f, 0.45f, 0.62f) * (is_edge ? 0.6f * lit : lit));
    }
    void draw_dot(vec3 p) {
        const float pixel = 2 * reach / size;
        const int x = static_cast<int>((p.x + reach) / pixel), y = static_cast<int>((reach - p.y) / pixel);
        for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx)
                if (dx * dx + dy * dy <= 10)
                    pixels_.at(static_cast<std::size_t>((y + dy) * int(size) + x + dx)) = {214, 40, 40};
    }

    const Mesh& body_;
    std::vector<Rgb> pixels_;
};
// [/picture]

void write_obj(const std::filesystem::path& file, const Mesh& mesh) {
    std::ofstream out(file);
    out.precision(9);  // as many digits as tell all float32 apart
    for (const vec3& p : mesh.positions) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    for (const uvec3& t : mesh.triangles) out << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
    if (!out.flush()) throw Error("'" + file.string() + "' could not be written");
}

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: robust_rays FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    Context context;
    // [main]
    const Mesh body = make_body();
    SwTlas accel(context, {.level = Level::refined});
    accel.push(body);
    const AimedRays aimed = aim_at_vertices(body, 4, 1);
    std::vector<std::vector<uint>> leaked;
    for (const Level level : {Level::fast, Level::watertight, Level::refined}) {
        leaked.push_back(leaked_vertices(accel, aimed, level));
        const LeakCounts crossings = count_crossings(context, body, level);
        std::cout << name_of(level) << ": " << leaked.back().size() << " of " << aimed.rays.size() << " rays got out; "
                  << crossings.leaks << " leaks and " << crossings.double_hits << " double hits of " << crossings.rays
                  << " rays that were counted\n";
        if (level != Level::fast && leaked.back().size() + crossings.faults() > 0) throw Error("a ray leaked");
    }
    // [/main]
    if (leaked[0].empty()) throw Error("no ray leaked at level fast: the picture would show nothing");
    Picture left(accel, body), right(accel, body);
    left.mark(leaked[0]);
    right.mark(leaked[1]);
    std::vector<Rgb> both;
    for (uint y = 0; y < Picture::size; ++y)
        for (const Picture* half : {&left, &right}) both.insert(both.end(), half->row(y).begin(), half->row(y).end());
    write_png(folder / "07_robust_rays.png", 2 * Picture::size, Picture::size, both);
    write_obj(folder / "body.obj", body);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
