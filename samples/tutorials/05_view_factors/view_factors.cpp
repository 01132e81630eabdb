// SPDX-License-Identifier: MIT
// Tutorial 5: view factors with intervals compared with a closed form, and a room lit by radiosity.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <vector>

#include <twinray/analysis.h>
#include <twinray/scene.h>
#include <twinray/tlas.h>
#include "twinray/glsl/vector_math.h"

using namespace twinray;

namespace {

// [squares]
// Two unit squares at a distance of 1 that face each other.
Scene facing_squares() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_quad(vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)),
                    make_quad(vec3(0, 0, 1), vec3(0, 1, 0), vec3(1, 0, 0))};
    scene.instances = {{"lower", 0, {}}, {"upper", 1, {}}};
    return scene;
}

// The closed form for such squares (Howell's catalogue, C-11).
double facing_squares_known() {
    const double root = std::sqrt(2.0);
    return 2 / std::numbers::pi * (std::log(2 / std::sqrt(3.0)) + 2 * root * std::atan(1 / root) - 2 * std::atan(1.0));
}
// [/squares]

struct Panel {
    Mesh mesh;
    vec3 reflectance;
    vec3 emission;
};

// [panel]
// A rectangle of 2 n n triangles, whose front looks along cross(u, v).
Mesh make_panel(vec3 corner, vec3 u, vec3 v, uint n) {
    Mesh mesh;
    mesh.name = "panel";
    for (uint j = 0; j <= n; ++j)
        for (uint i = 0; i <= n; ++i) {
            const float a = float(i) / float(n), b = float(j) / float(n);
            mesh.positions.push_back(corner + a * u + b * v);
        }
    for (uint j = 0; j < n; ++j)
        for (uint i = 0; i < n; ++i) {
            const uint p = j * (n + 1) + i, above = p + n + 1;
            mesh.triangles.push_back({p, p + 1, above + 1});
            mesh.triangles.push_back({p, above + 1, above});
        }
    return mesh;
}
// [/panel]

// The top and the four sides of a box on the floor, from (x, 0, z), turned by an angle whose cosine and sine are given.
void add_box(std::vector<Panel>& panels, vec3 from, float side, float height, vec2 turn) {
    const vec3 u(side * turn.x, 0, -side * turn.y), w(side * turn.y, 0, side * turn.x), up(0, height, 0);
    const vec3 grey(0.7f), dark(0);
    for (const Mesh& mesh : {make_panel(from + up, w, u, 6), make_panel(from + w, u, up, 6), make_panel(from, w, up, 6),
                             make_panel(from + (u + w), -w, up, 6), make_panel(from + u, -u, up, 6)})
        panels.push_back({mesh, grey, dark});
}

// A box of side 1, open towards +z, with a red wall on the left, a green one on the right and a lamp under the ceiling.
std::vector<Panel> room() {
    const vec3 grey(0.7f), red(0.6f, 0.06f, 0.05f), green(0.1f, 0.45f, 0.1f), dark(0);
    std::vector<Panel> panels = {
        {make_panel({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 14), grey, dark},            // floor
        {make_panel({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 14), grey, dark},            // ceiling
        {make_panel({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 14), grey, dark},            // back
        {make_panel({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 14), red, dark},             // left
        {make_panel({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 14), green, dark},           // right
        {make_panel({0.35f, 0.98f, 0.35f}, {0.3f, 0, 0}, {0, 0, 0.3f}, 4), dark,  // lamp
         vec3(12, 11, 9)},
    };
    add_box(panels, {0.56f, 0, 0.5f}, 0.28f, 0.28f, {0.95f, -0.31225f});
    add_box(panels, {0.14f, 0, 0.24f}, 0.28f, 0.58f, {0.95f, 0.31225f});
    return panels;
}

bool holds(const ViewFactor& factor, double truth) { return factor.low <= truth && truth <= factor.high; }

// [cube]
// Light from each wall of a closed cube if all walls emit 1 and reflect half: 1 + 1/2 + 1/4 + ... = 2.
std::vector<double> light_in_cube(Context& context) {
    Scene scene;
    scene.materials.resize(1);
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0);
    scene.meshes = {make_quad(o, x, y), make_quad(z, y, x), make_quad(o, y, z),
                    make_quad(x, z, y), make_quad(o, z, x), make_quad(y, x, z)};
    for (uint wall = 0; wall < 6; ++wall) scene.instances.push_back({"wall", wall, {}});
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    const ViewFactorOptions options{.grouping = FaceGrouping::instance};
    const PairExchanges pairs = exchanges_of_pairs(accel, faces, options, PairEstimator::automatic);
    ViewFactors factors(accel, faces, options, pairs.known);
    const std::vector<double> emission(6, 1.0), reflectance(6, 0.5);
    return solve_radiosity(factors.rows(0, 6), emission, reflectance).values;
}
// [/cube]

Scene scene_of_panels(const std::vector<Panel>& panels) {
    Scene scene;
    scene.materials.resize(1);
    for (const Panel& panel : panels) {
        scene.instances.push_back({"panel", static_cast<uint>(scene.meshes.size()), {}});
        scene.meshes.push_back(panel.mesh);
    }
    return scene;
}

// [light]
// Returns the light that each face sends out in red, green and blue.
std::vector<vec3> light_of_faces(Context& context, const std::vector<Panel>& panels, const Scene& scene) {
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    ViewFactors factors(accel, faces, {.rays = 2048});
    const std::vector<ViewFactorRow> rows = factors.rows(0, factors.row_count());
    std::vector<vec3> light(faces.count());
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> emission, reflectance;
        for (std::size_t face = 0; face < faces.count(); ++face) {
            const Panel& panel = panels[faces[face].instance];
            emission.push_back(panel.emission[std::size_t(channel)]);
            reflectance.push_back(panel.reflectance[std::size_t(channel)]);
        }
        const Radiosity solved = solve_radiosity(rows, emission, reflectance);
        for (std::size_t face = 0; face < faces.count(); ++face)
            light[face][std::size_t(channel)] = static_cast<float>(solved.values[face]);
    }
    return light;
}

// [smooth]
// Returns the light at the vertices of each panel, the mean of the faces around it, so that a picture shows no facets.
std::vector<std::vector<vec3>> light_of_vertices(const Scene& scene, const std::vector<vec3>& light) {
    std::vector<std::vector<vec3>> result;
    std::size_t face = 0;
    for (const Mesh& mesh : scene.meshes) {
        std::vector<vec3> sums(mesh.positions.size());
        std::vector<float> counts(mesh.positions.size());
        for (const uvec3& triangle : mesh.triangles) {
            for (const uint vertex : {triangle.x, triangle.y, triangle.z}) {
                sums[vertex] += light[face];
                ++counts[vertex];
            }
            ++face;
        }
        for (std::size_t vertex = 0; vertex < sums.size(); ++vertex) sums[vertex] /= counts[vertex];
        result.push_back(std::move(sums));
    }
    return result;
}

// [picture]
void draw(const std::filesystem::path& file, Context& context, const Scene& scene, const std::vector<vec3>& light) {
    constexpr uint width = 640, height = 480;
    const ImagePlane plane =
        image_plane(look_camera({0.5f, 0.5f, 2.35f}, {0.5f, 0.5f, 0}, {0, 1, 0}, 42), float(width) / float(height));
    std::vector<Ray> rays;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            rays.push_back(ray_through(
                plane, vec2(2 * (float(x) + 0.5f) / float(width) - 1, 1 - 2 * (float(y) + 0.5f) / float(height))));
    SwTlas accel(context);
    push_scene(accel, scene);
    const std::vector<std::vector<vec3>> at_vertices = light_of_vertices(scene, light);
    std::vector<Rgb> pixels;
    for (const Hit& hit : accel.closest_hits(rays, {.cull = Cull::back})) {
        vec3 color(0);
        if (hit.hit) {
            const uvec3 corners = scene.meshes[hit.instance_index].triangles[hit.primitive_index];
            const std::vector<vec3>& values = at_vertices[hit.instance_index];
            color = (1 - hit.u - hit.v) * values[corners.x] + hit.u * values[corners.y] + hit.v * values[corners.z];
        }
        pixels.push_back(rgb_of_linear(color));
    }
    write_png(file, width, height, pixels);
}
// [/picture]

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    // [first]
    Context context;
    const Scene scene = facing_squares();
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);

    const ViewFactorOptions options{.grouping = FaceGrouping::instance, .rays = 16384};
    ViewFactors factors(accel, faces, options);
    const ViewFactorRow row = factors.rows(0, 1).front();  // of the lower square
    const ViewFactor sampled = row.factors.front();
    std::cout << "by rays F = " << sampled.value << " from " << sampled.low << " to " << sampled.high
              << "; the formula says " << facing_squares_known() << '\n'
              << row.open.value << " of the light meets nothing\n";

    // [contour]
    const PairExchanges pairs = exchanges_of_pairs(accel, faces, options, PairEstimator::automatic);
    ViewFactors better(accel, faces, options, pairs.known);
    const ViewFactor exact = better.rows(0, 1).front().factors.front();
    std::cout << "by " << name_of(exact.by) << "s F = " << exact.value << ", off by "
              << std::abs(exact.value - facing_squares_known()) << '\n';

    // [coverage]
    int held = 0;
    for (uint seed = 1; seed <= 100; ++seed) {
        ViewFactors again(accel, faces, {.grouping = FaceGrouping::instance, .rays = 4096, .seed = seed});
        held += holds(again.rows(0, 1).front().factors.front(), facing_squares_known());
    }
    std::cout << "of 100 intervals " << held << " hold the truth\n";
    // [/coverage]

    const std::vector<double> cube = light_in_cube(context);
    std::cout << "each wall of the cube sends " << cube.front() << ", by the series 2\n";

    const std::vector<Panel> panels = room();
    const Scene furnished = scene_of_panels(panels);
    const std::vector<vec3> light = light_of_faces(context, panels, furnished);
    draw(folder / "05_view_factors.png", context, furnished, light);
    std::cout << "the room has " << light.size() << " faces\n";

    const bool is_exact =
        std::abs(exact.value / facing_squares_known() - 1) < 1e-6 && holds(exact, facing_squares_known());
    for (const double value : cube)
        if (std::abs(value - 2) > 1e-6) return 1;
    if (!is_exact || held < 85) return 1;
    std::cout << "the answers hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
