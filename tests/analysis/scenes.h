// Scenes for which tests know what is seen, also in closed form, and analyses by an accelerator.
#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>

#include <twinray/analysis.h>
#include <twinray/scene.h>

#include "engine/analysis/faces.h"
#include "engine/analysis/pair_plan.h"
#include "tests/accel/accel_fixture.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {

// Makes one instance of each mesh, or as many of the only mesh as there are transforms.
inline Scene scene_of(std::vector<Mesh> meshes, const std::vector<Transform>& transforms = {{}}) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = std::move(meshes);
    if (scene.meshes.size() == 1)
        for (const Transform& transform : transforms) scene.instances.push_back({"", 0, transform});
    else
        for (uint i = 0; i < scene.meshes.size(); ++i) scene.instances.push_back({"", i, transforms.front()});
    return scene;
}

// Makes a cube about `middle` with sides of 2, seen from inside, with each wall cut into n by n squares. It is turned
// about two axes and rounded to float32: walls miss their planes by that.
inline Scene rounded_room(uint n, double angle, const dvec3& middle = dvec3(0)) {
    const double c = std::cos(angle), s = std::sin(angle);
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<uint>(mesh.positions.size());
            for (uint i = 0; i < (n + 1) * (n + 1); ++i) {
                dvec3 p(side);
                p[(axis + 1) % 3] = -1 + 2.0 * (i % (n + 1)) / n;
                p[(axis + 2) % 3] = -1 + 2.0 * (i / (n + 1)) / n;
                const dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
                mesh.positions.push_back(vec3(dvec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z) + middle));
            }
            for (uint i = 0; i < n * n; ++i) {
                const uint at = first + i / n * (n + 1) + i % n, next = at + n + 1;
                for (const uvec3& t : {uvec3(at, at + 1, next + 1), uvec3(at, next + 1, next)})
                    mesh.triangles.push_back(side < 0 ? t : uvec3(t.x, t.z, t.y));
            }
        }
    return scene_of({mesh});
}

struct KnownFactor {
    std::string name;
    Scene scene;
    double value;             // from mesh 0 to mesh 1
    std::size_t entries = 1;  // of mesh 0
};

// Makes squares with sides of 1 that face each other at this distance.
inline Scene parallel_squares(float distance) {
    return scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                     make_quad(vec3(0, 0, distance), vec3(0, 1, 0), vec3(1, 0, 0))});
}

// Makes rectangles with a common edge of 1: the first w wide in the plane z = 0, the second h high.
inline Scene perpendicular_rectangles(float w, float h) {
    return scene_of(
        {make_quad(vec3(0), vec3(w, 0, 0), vec3(0, 1, 0)), make_quad(vec3(0), vec3(0, 1, 0), vec3(0, 0, h))});
}

// Makes parallel squares, and a smaller one half way between them.
inline Scene plate_between(float distance) {
    return scene_of({make_quad(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)),
                     make_quad(vec3(0, 0, distance), vec3(0, 1, 0), vec3(1, 0, 0)),
                     make_quad(vec3(0.2f, 0.2f, distance / 2), vec3(0, 0.6f, 0), vec3(0.6f, 0, 0))});
}

// Turns a mesh so that it is seen from inside.
inline Mesh turned(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

// Makes a regular polygon of n vertices on a circle about the z axis, which looks up.
inline Mesh make_disc(int n, float radius) {
    Mesh mesh;
    mesh.positions.push_back(vec3(0));
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        mesh.positions.push_back(radius * vec3(std::cos(angle), std::sin(angle), 0));
        const auto first = static_cast<uint>(i + 1);
        mesh.triangles.push_back({0, first, i + 1 == n ? 1 : first + 1});
    }
    return mesh;
}

// Returns an entry of value 0 if there is none.
inline const ViewFactor& entry_of(const ViewFactorRow& row, uint target) {
    static const ViewFactor none;
    for (const ViewFactor& entry : row.factors)
        if (entry.target == target) return entry;
    return none;
}

inline bool is_same(const ViewFactorRow& a, const ViewFactorRow& b) {
    const auto equal = [](const ViewFactor& x, const ViewFactor& y) {
        return x.target == y.target && x.value == y.value && x.low == y.low && x.high == y.high;
    };
    return a.group == b.group && a.rays == b.rays && a.hits == b.hits && a.open.value == b.open.value &&
           a.back.value == b.back.value &&
           std::equal(a.factors.begin(), a.factors.end(), b.factors.begin(), b.factors.end(), equal);
}

// Returns A F in float64 from mesh 0 to mesh 1, if nothing is between them.
inline double contour_flow(const Scene& scene) {
    const FacePolygons polygons(scene);
    const auto first = static_cast<uint>(scene.meshes[0].triangles.size());
    std::vector<std::vector<uint>> meshes(2);
    for (uint face = 0; face < polygons.faces.size(); ++face) meshes[face < first ? 0 : 1].push_back(face);
    for (const PlannedPair& pair : plan_pairs(polygons, meshes, {}).pairs)
        if (pair.i == 0 && pair.j == 1) return pair.contour.flow;
    return 0;
}

// A long run takes more than CI has time for: TWINRAY_SEEDS=1000.
inline uint seeds() {
    const char* asked = std::getenv("TWINRAY_SEEDS");
    return asked ? static_cast<uint>(std::atoi(asked)) : 20;
}

// Returns a transform that rotates, stretches unevenly and moves.
inline Transform skewed() {
    return {{vec4(1.5f, -0.5f, 0.25f, 3), vec4(0.5f, 2, -0.75f, -1), vec4(0.25f, 0.5f, 0.625f, 5)}};
}

// Returns the same transform, which also turns inside out.
inline Transform mirrored() { return skewed() * Transform::scaling(vec3(-1, 1, 1)); }

class AnalysisTest : public AccelTest {
  protected:
    // Empties the accelerator, then pushes the scene.
    void fill(const Scene& scene) {
        for (const AccelHandle handle : accel().handles()) accel().erase(handle);
        push_scene(accel(), scene);
    }
};

}  // namespace twinray::test

#define TWINRAY_OVER_SOFTWARE(Fixture)                                                         \
    INSTANTIATE_TEST_SUITE_P(The, Fixture, ::testing::Values(::twinray::test::Kind::software), \
                             ::twinray::test::name_of_kind)
