// Houses of 10 m in metres of UTM, with centimetres as surveyors give them.
#pragma once

#include <iomanip>

#include "tests/scene/gltf_builder.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {

inline const dvec3 far_away(500'000, 5'400'000, 0);

struct House {
    dvec3 lo, hi;  // in the file's coordinates
};

inline std::vector<House> far_houses() {
    std::vector<House> houses;
    for (const dvec3& corner :
         {dvec3(0.13, 0.27, 0.08), dvec3(13.46, 0.91, 0.21), dvec3(0.38, 12.77, 0.35), dvec3(13.09, 13.62, 0.54)})
        houses.push_back({far_away + corner, far_away + corner + dvec3(10, 8.64, 3.21)});
    return houses;
}

// Corner i of a house has the high x, y, z where bits 0, 1, 2 of i are set; fronts look outward.
inline const std::vector<uvec3> house_triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
inline dvec3 corner_of(const House& house, uint i) {
    return {(i & 1 ? house.hi : house.lo).x, (i & 2 ? house.hi : house.lo).y, (i & 4 ? house.hi : house.lo).z};
}

// Expects every corner of every house, in the file's coordinates.
inline void expect_far_houses(const Scene& scene, double tolerance) {
    std::vector<dvec3> found;
    for (const Instance& instance : scene.instances)
        for (const vec3& position : scene.meshes[instance.mesh].positions)
            found.push_back(scene.origin + dvec3(transform_point(instance.transform, position)));
    ASSERT_EQ(found.size(), 8 * far_houses().size());
    for (const House& house : far_houses())
        for (uint i = 0; i < 8; ++i) {
            double nearest = INFINITY;
            for (const dvec3& point : found) nearest = std::min(nearest, length(point - corner_of(house, i)));
            EXPECT_LE(nearest, tolerance);
        }
}

// The rounding error of a model of this size at the origin.
inline constexpr double rounding = 2e-6;

// Writes ASCII, to the millimetre. `type` is that of coordinates, as the header names it.
inline std::string far_houses_ply(const std::string& type) {
    const std::vector<House> houses = far_houses();
    std::ostringstream out;
    out << std::fixed << std::setprecision(3) << "ply\nformat ascii 1.0\nelement vertex " << 8 * houses.size();
    for (const char* axis : {"x", "y", "z"}) out << "\nproperty " << type << ' ' << axis;
    out << "\nelement face " << 12 * houses.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const House& house : houses)
        for (uint i = 0; i < 8; ++i) {
            const dvec3 p = corner_of(house, i);
            out << p.x << ' ' << p.y << ' ' << p.z << '\n';
        }
    for (uint house = 0; house < houses.size(); ++house)
        for (const uvec3& t : house_triangles) {
            const uvec3 corners = t + 8 * house;
            out << "3 " << corners.x << ' ' << corners.y << ' ' << corners.z << '\n';
        }
    return out.str();
}

// Makes one mesh; each node places it as a house, at its low corner.
inline GltfBuilder far_houses_gltf() {
    GltfBuilder gltf = one_triangle();
    const House house{dvec3(0), dvec3(10, 8.64, 3.21)};
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (uint i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(corner_of(house, i)[axis]));
    for (const uvec3& t : house_triangles)
        for (int i = 0; i < 3; ++i) indices.push_back(static_cast<std::uint16_t>(t[i]));
    gltf.primitive() = {{"attributes", {{"POSITION", gltf.add_floats("VEC3", positions)}}},
                        {"indices", gltf.add_indices(indices)}};
    gltf.root["nodes"].clear();
    gltf.root["scenes"][0]["nodes"].clear();
    for (const House& placed : far_houses())
        gltf.add_node({{"mesh", 0}, {"translation", {placed.lo.x, placed.lo.y, placed.lo.z}}});
    return gltf;
}

}  // namespace twinray::test
