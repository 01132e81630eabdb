// SPDX-License-Identifier: MIT
#include "bindings/python/analysis.h"

#include <algorithm>

namespace twinray::python {
namespace {

PairEstimator estimator_of(const std::string& name) {
    for (const PairEstimator estimator : all_pair_estimators)
        if (name_of(estimator) == name) return estimator;
    throw Error("estimator '" + name + "' is not one of auto, hits, area, contour");
}

Sides sides_of(bool both) { return both ? Sides::both : Sides::front; }

FaceGrouping group(Faces& faces, std::vector<uint>&& groups) {
    if (groups.empty()) return FaceGrouping::face;
    faces.set_custom_groups(std::move(groups));
    return FaceGrouping::custom;
}

// Looks at pairs one by one if there are few enough of them.
PairExchanges pairs_of(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                       PairEstimator estimator) {
    const auto count = std::count_if(faces.areas().begin(), faces.areas().end(), [](double area) { return area > 0; });
    if (estimator == PairEstimator::automatic && static_cast<std::size_t>(count) > most_paired_faces) return {};
    return exchanges_of_pairs(accel, faces, options, estimator);
}

void append(Matrix& matrix, const ViewFactorRow& row) {
    for (const ViewFactor& factor : row.factors) {
        matrix.column.push_back(factor.target);
        matrix.value.push_back(factor.value);
        matrix.low.push_back(factor.low);
        matrix.high.push_back(factor.high);
    }
    matrix.first.push_back(matrix.column.size());
    matrix.open.push_back(row.open.value);
    matrix.rays += row.rays;
}

}  // namespace

struct MatrixRows::State {
    State(AbstractAccel& accel, MatrixOptions&& options)
        : faces(accel),
          asked{.grouping = group(faces, std::move(options.groups)),
                .sides = sides_of(options.both_sides),
                .rays = options.rays,
                .target_error = options.target_error,
                .seed = options.seed},
          pairs(pairs_of(accel, faces, asked, estimator_of(options.estimator))),
          factors(accel, faces, asked, pairs.known) {}

    Faces faces;
    ViewFactorOptions asked;
    PairExchanges pairs;
    ViewFactors factors;
};

MatrixRows::MatrixRows(Scene& scene, MatrixOptions options) : scene_(scene) {
    const Scene::Turn turn(scene);
    scene.progress().done = 0;
    scene.progress().total = 0;
    state_ = std::make_unique<State>(turn.accel(), std::move(options));
}

MatrixRows::~MatrixRows() {
    const Scene::Turn turn(scene_);
    state_.reset();
}

std::size_t MatrixRows::count() const { return state_->factors.row_count(); }

Matrix MatrixRows::rows(std::size_t first, std::size_t last) {
    if (first > last || last > count())
        throw Error("view factors: rows " + std::to_string(first) + " to " + std::to_string(last) + "; there are " +
                    std::to_string(count()));
    const Scene::Turn turn(scene_);
    ViewFactors& factors = state_->factors;
    Matrix matrix;
    matrix.first.push_back(0);
    scene_.progress().total = last - first;
    for (std::size_t next = first; next < last; next += factors.batch_size()) {
        scene_.progress().done = next - first;
        for (const ViewFactorRow& row : factors.rows(next, std::min(next + factors.batch_size(), last)))
            append(matrix, row);
    }
    if (first == 0) matrix.rays += state_->pairs.rays;
    return matrix;
}

Light illumination(Scene& scene, dvec3 direction, std::uint32_t side, bool both_sides, std::uint64_t seed,
                   const std::vector<uint>& groups) {
    const Scene::Turn turn(scene);
    Faces faces(turn.accel());
    const FaceGrouping by = group(faces, std::vector<uint>(groups));
    const Illumination found = illuminate(
        turn.accel(), faces,
        {.grid = {.direction = direction, .side = side, .seed = seed}, .sides = sides_of(both_sides), .by = by});
    Light light;
    light.rays = found.ray_count;
    for (const LitArea& lit : found.groups)
        light.groups.push_back({static_cast<double>(lit.hits), lit.area, lit.interval.low, lit.interval.high,
                                lit.unobstructed, lit.surface});
    return light;
}

std::vector<std::array<double, 3>> sky_light(Scene& scene, dvec3 zenith, std::uint32_t samples, bool both_sides,
                                             std::uint64_t seed) {
    const Scene::Turn turn(scene);
    const Faces faces(turn.accel());
    const SkyLight found = twinray::sky_light(turn.accel(), faces, zenith,
                                              {.samples = samples, .sides = sides_of(both_sides), .seed = seed});
    std::vector<std::array<double, 3>> rows;
    for (const Received& received : found.faces)
        rows.push_back({received.value, received.interval.low, received.interval.high});
    return rows;
}

Centroid centroid_of(Scene& scene, dvec3 direction, std::uint32_t side, std::uint64_t seed) {
    const Scene::Turn turn(scene);
    return centroid(turn.accel(), {.grid = {.direction = direction, .side = side, .seed = seed}});
}

Touching collide(Scene& scene, bool self, bool by_position, bool segments) {
    const Scene::Turn turn(scene);
    const ContactOptions options{.self = self,
                                 .shared = by_position ? SharedVertices::by_position : SharedVertices::by_index,
                                 .segments = segments};
    Contacts found = NarrowPhase(turn.accel().context()).find(turn.accel(), options);
    const std::vector<uint> numbers = scene.geometries();
    Touching touching;
    for (const TriangleContact& contact : found.list)
        touching.contacts.push_back({numbers[contact.instance_a], numbers[contact.instance_b], contact.triangle_a,
                                     contact.triangle_b, static_cast<uint>(contact.pair_class)});
    touching.segments = std::move(found.segments);
    return touching;
}

VerifyResult verify(Scene& scene, std::vector<Ray>&& rays, std::size_t count, std::uint64_t seed) {
    const Scene::Turn turn(scene);
    turn.accel().sync();
    const twinray::Scene held = scene_of(turn.accel());
    const Reference reference(held);
    if (rays.empty()) {
        rays = random_rays(bounds_of(held), count - count / 2, seed);
        for (const auto& make : {vertex_aimed_rays, edge_aimed_rays})
            for (const Ray& ray : make(reference, count / 4, seed)) rays.push_back(ray);
    }
    const TracedBy by = turn.accel().is_software() ? TracedBy::software : TracedBy::hardware;
    VerifyResult result;
    result.classes = reference.classify(rays, turn.accel().closest_hits(rays, {.level = turn.level()}), by);
    result.counts = twinray::count(result.classes);
    result.rays = std::move(rays);
    return result;
}

std::vector<std::uint8_t> visible(Scene& scene, std::span<const vec3> points, std::span<const vec3> vectors,
                                  std::span<const vec3> normals, float t_near, float t_far) {
    const Scene::Turn turn(scene);
    return visibility(turn.accel(), points, vectors, normals, {.t_near = t_near, .t_far = t_far});
}

std::vector<float> horizon(Scene& scene, const HeightRaster& raster, const HorizonDesc& desc) {
    const Scene::Turn turn(scene);
    return twinray::horizon(turn.accel().context(), raster, desc);
}

}  // namespace twinray::python
