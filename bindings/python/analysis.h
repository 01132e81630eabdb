// SPDX-License-Identifier: MIT
// Analyses of a scene for Python, as arrays. Faces are numbered by geometry, in the order of their numbers, then by
// triangle.
#pragma once

#include <twinray/analysis.h>
#include <twinray/validation.h>

#include <memory>

#include "bindings/python/scene.h"

namespace twinray::python {

// Row i has the entries from first[i] to first[i + 1] - 1.
struct Matrix {
    std::vector<std::uint64_t> first;
    std::vector<uint> column;
    std::vector<float> value, low, high;
    std::vector<double> open;  // by row
    std::uint64_t rays = 0;
};

struct MatrixOptions {
    std::vector<uint> groups;  // by face; empty: each face is one
    bool both_sides = false;
    std::uint64_t rays = 1 << 14;
    std::optional<double> target_error;
    std::uint32_t seed = 1;
    std::string estimator = "auto";
};

// The light of each face or group of faces, in columns hits, area, low, high, unobstructed, surface.
struct Light {
    std::vector<std::array<double, 6>> groups;
    std::uint64_t rays = 0;
};

// A row for each contact: instance_a, instance_b, triangle_a, triangle_b, class. Instances are numbers of geometries.
struct Touching {
    std::vector<std::array<uint, 5>> contacts;
    std::vector<ContactSegment> segments;
};

// View factors of a scene, which must not change meanwhile: any rows, in any order and any number at a time. Pairs of
// faces are looked at once. The scene must outlive it.
class MatrixRows {
  public:
    MatrixRows(Scene& scene, MatrixOptions options);
    ~MatrixRows();

    std::size_t count() const;
    // Returns rows [first, last); a row does not depend on the others. Throws Error also for rows that do not exist.
    Matrix rows(std::size_t first, std::size_t last);

  private:
    struct State;
    Scene& scene_;
    std::unique_ptr<State> state_;
};

// All of these throw Error as the functions of twinray/analysis.h and queries.h do.
Light illumination(Scene& scene, dvec3 direction, std::uint32_t side, bool both_sides, std::uint64_t seed,
                   const std::vector<uint>& groups);
// Returns value, low and high of each face.
std::vector<std::array<double, 3>> sky_light(Scene& scene, dvec3 zenith, std::uint32_t samples, bool both_sides,
                                             std::uint64_t seed);
Centroid centroid_of(Scene& scene, dvec3 direction, std::uint32_t side, std::uint64_t seed);
Touching collide(Scene& scene, bool self, bool by_position, bool segments);

// The closest hits of rays, judged by the reference in float64. Without rays, `count` are made: half of them random, a
// quarter aimed at vertices and a quarter at edges.
struct VerifyResult {
    std::vector<Ray> rays;
    std::vector<HitClass> classes;  // by ray
    HitClassCounts counts;
};
VerifyResult verify(Scene& scene, std::vector<Ray>&& rays, std::size_t count, std::uint64_t seed);

std::vector<std::uint8_t> visible(Scene& scene, std::span<const vec3> points, std::span<const vec3> vectors,
                                  std::span<const vec3> normals, float t_near, float t_far);

// Computes on the device of the scene.
std::vector<float> horizon(Scene& scene, const HeightRaster& raster, const HorizonDesc& desc);

}  // namespace twinray::python
