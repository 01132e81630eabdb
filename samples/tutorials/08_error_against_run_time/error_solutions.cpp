// SPDX-License-Identifier: MIT
// Solutions of exercises 1 and 3.
#include <cmath>
#include <iostream>

#include "contestants.h"
#include "twinray/glsl/vector_math.h"

using namespace twinray;

namespace {

// [exercise1]
// Returns how steeply a ray meets a triangle: 1 is straight on, 0 along it.
float steepness(const Mesh& mesh, const Ray& ray, uint triangle) {
    const uvec3 corners = mesh.triangles[triangle];
    const vec3 a = mesh.positions[corners.x];
    const vec3 normal = cross(mesh.positions[corners.y] - a, mesh.positions[corners.z] - a);
    return std::abs(dot(normalize(normal), normalize(ray.direction)));
}

// Returns the 99th percentile of the error of t over the rays that meet their triangle so steeply.
double error_between(float low, float high, AbstractAccel& accel, const Scene& scene) {
    const std::vector<Ray> all = random_rays(bounds_of(scene), 1 << 17, 1);
    const std::vector<ReferenceHit> truth_of_all = truth_of(Reference(scene), all);
    std::vector<Ray> rays;
    std::vector<ReferenceHit> truth;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const ReferenceHit& hit = truth_of_all[i];
        const float steep = hit.hit ? steepness(scene.meshes[0], all[i], hit.primitive) : -1;
        if (steep < low || steep >= high) continue;
        rays.push_back(all[i]);
        truth.push_back(hit);
    }
    return quantile(errors_of_t(truth, accel.closest_hits(rays)), 0.99);
}
// [/exercise1]

void exercise_1(Context& context) {
    Scene scene;
    scene.meshes = {make_icosphere(6)};
    scene.instances = {{"sphere", 0, {}}};
    SwTlas accel(context);
    push_scene(accel, scene);
    const double grazing = error_between(0, 0.1f, accel, scene), steep = error_between(0.5f, 1.1f, accel, scene);
    std::cout << "1: 99 % of the grazing rays are within " << grazing << " ulp, of the steep ones within " << steep
              << '\n';
    if (grazing < 3 * steep) throw Error("grazing rays have no larger errors");
}

// [exercise3]
// Traces as many rays as a 95 % interval of +- `error` needs.
ViewFactorRow row_within(double error, Sequence sequence, Context& context) {
    const Scene scene = facing_squares();
    SwTlas accel(context);
    push_scene(accel, scene);
    const Faces faces(context, scene);
    ViewFactors factors(accel, faces,
                        {.grouping = FaceGrouping::instance,
                         .sequence = sequence,
                         .rays = 1 << 24,  // at most
                         .target_error = error});
    return factors.rows(0, 1).front();
}
// [/exercise3]

void exercise_3(Context& context) {
    const double wanted = 0.001;
    for (const Sequence sequence : {Sequence::random, Sequence::sobol}) {
        const ViewFactorRow row = row_within(wanted, sequence, context);
        const ViewFactor& factor = row.factors.front();
        const double half = (double{factor.high} - double{factor.low}) / 2;
        const double error = std::abs(double{factor.value} - known_factor());
        std::cout << "3: " << name_of(sequence) << ": " << row.rays << " rays for +- " << half << "; the error is "
                  << error << '\n';
        if (half > wanted || error > 2 * half) throw Error("the interval does not keep its word");
    }
}

}  // namespace

int main() try {
    Context context;
    exercise_1(context);
    exercise_3(context);
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
