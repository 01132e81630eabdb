// Analyses of a scene for Python, as arrays. Faces are numbered by geometry, in the order of their numbers, then by
// triangle.
#include <twinray/analysis.h>
#include <twinray/validation.h>

#include <algorithm>

#include "bindings/python/convert.h"

namespace twinray::python {
namespace {

PairEstimator estimator_of(const std::string& name) {
    for (const PairEstimator estimator : all_pair_estimators)
        if (name_of(estimator) == name) return estimator;
    throw Error("estimator '" + name + "' is not one of auto, hits, area, contour");
}

Sides sides_of(bool both) { return both ? Sides::both : Sides::front; }

// `groups`: by face; empty: each face is one.
FaceGrouping group(Faces& faces, const std::vector<uint>& groups) {
    if (groups.empty()) return FaceGrouping::face;
    faces.set_custom_groups(groups);
    return FaceGrouping::custom;
}

// Looks at pairs one by one if there are few enough of them.
PairExchanges pairs_of(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                       PairEstimator estimator) {
    const auto count = std::ranges::count_if(faces.areas(), [](double area) { return area > 0; });
    if (estimator == PairEstimator::automatic && static_cast<std::size_t>(count) > most_paired_faces) return {};
    return exchanges_of_pairs(accel, faces, options, estimator);
}

// Row i has the entries from first[i] to first[i + 1] - 1.
struct Matrix {
    std::vector<std::uint64_t> first{0};
    std::vector<uint> column;
    std::vector<float> value, low, high;
    std::vector<double> open;  // by row
    std::uint64_t rays = 0;

    void append(const ViewFactorRow& row) {
        for (const ViewFactor& factor : row.factors) {
            column.push_back(factor.target);
            value.push_back(factor.value);
            low.push_back(factor.low);
            high.push_back(factor.high);
        }
        first.push_back(column.size());
        open.push_back(row.open.value);
        rays += row.rays;
    }
};

// View factors of a scene, which must not change meanwhile: any rows, in any order and any number at a time. Pairs of
// faces are looked at once. The scene must outlive it.
class MatrixRows {
  public:
    MatrixRows(Scene& scene, const std::vector<uint>& groups, const ViewFactorOptions& options,
               const std::string& estimator)
        : scene_(scene) {
        const Scene::Turn turn(scene);
        scene.progress().done = 0;
        scene.progress().total = 0;
        state_ = std::make_unique<State>(turn.accel(), groups, options, estimator);
    }
    ~MatrixRows() {
        const Scene::Turn turn(scene_);
        state_.reset();
    }

    std::size_t count() const { return state_->factors->row_count(); }

    // Returns rows [first, last); a row does not depend on the others. Throws Error also for rows that do not exist.
    Matrix rows(std::size_t first, std::size_t last) {
        if (first > last || last > count())
            throw Error("view factors: rows " + std::to_string(first) + " to " + std::to_string(last) + "; there are " +
                        std::to_string(count()));
        const Scene::Turn turn(scene_);
        ViewFactors& factors = *state_->factors;
        Matrix matrix;
        scene_.progress().total = last - first;
        for (std::size_t next = first; next < last; next += factors.batch_size()) {
            scene_.progress().done = next - first;
            for (const ViewFactorRow& row : factors.rows(next, std::min(next + factors.batch_size(), last)))
                matrix.append(row);
        }
        if (first == 0) matrix.rays += state_->pairs.rays;
        return matrix;
    }

  private:
    struct State {
        State(AbstractAccel& accel, const std::vector<uint>& groups, ViewFactorOptions options,
              const std::string& estimator)
            : faces(accel) {
            options.grouping = group(faces, groups);
            pairs = pairs_of(accel, faces, options, estimator_of(estimator));
            factors.emplace(accel, faces, options, pairs.known);
        }

        Faces faces;
        PairExchanges pairs;
        std::optional<ViewFactors> factors;
    };
    Scene& scene_;
    std::unique_ptr<State> state_;
};

nb::dict rows_of_matrix(MatrixRows& rows, std::size_t first, std::size_t last) {
    Matrix matrix = unlocked([&] { return rows.rows(first, last); });
    nb::dict arrays;
    arrays["first"] = given<std::uint64_t>(std::move(matrix.first));
    arrays["column"] = given<uint>(std::move(matrix.column));
    arrays["value"] = given<float>(std::move(matrix.value));
    arrays["low"] = given<float>(std::move(matrix.low));
    arrays["high"] = given<float>(std::move(matrix.high));
    arrays["open"] = given<double>(std::move(matrix.open));
    arrays["rays"] = matrix.rays;
    return arrays;
}

// Returns columns hits, area, low, high, unobstructed and surface of each face or group, and the number of rays.
nb::tuple bound_illumination(Scene& scene, const Vector& direction, std::uint32_t side, bool both_sides,
                             std::uint64_t seed, const std::vector<uint>& groups) {
    const Illumination found = unlocked([&] {
        const Scene::Turn turn(scene);
        Faces faces(turn.accel());
        const FaceGrouping by = group(faces, groups);
        return illuminate(turn.accel(), faces,
                          {.grid = {.direction = vector_of(direction), .side = side, .seed = seed},
                           .sides = sides_of(both_sides),
                           .by = by});
    });
    std::vector<std::array<double, 6>> rows;
    for (const LitArea& lit : found.groups)
        rows.push_back({static_cast<double>(lit.hits), lit.area, lit.interval.low, lit.interval.high, lit.unobstructed,
                        lit.surface});
    return nb::make_tuple(given<double>(std::move(rows), 6), found.ray_count);
}

// Returns value, low and high of each face.
nb::object bound_sky_light(Scene& scene, const Vector& zenith, std::uint32_t samples, bool both_sides,
                           std::uint64_t seed) {
    const SkyLight found = unlocked([&] {
        const Scene::Turn turn(scene);
        const Faces faces(turn.accel());
        return sky_light(turn.accel(), faces, vector_of(zenith),
                         {.samples = samples, .sides = sides_of(both_sides), .seed = seed});
    });
    std::vector<Vector> rows;
    for (const Received& received : found.faces)
        rows.push_back({received.value, received.interval.low, received.interval.high});
    return given<double>(std::move(rows), 3);
}

nb::tuple bound_centroid(Scene& scene, const Vector& direction, std::uint32_t side, std::uint64_t seed) {
    const Centroid found = unlocked([&] {
        const Scene::Turn turn(scene);
        return centroid(turn.accel(), {.grid = {.direction = vector_of(direction), .side = side, .seed = seed}});
    });
    const auto tuple = [](const std::optional<dvec3>& v) {
        return v ? nb::object(nb::make_tuple(v->x, v->y, v->z)) : nb::object(nb::none());
    };
    return nb::make_tuple(tuple(found.mean), tuple(found.standard_error), found.point_count, found.ray_count);
}

// Returns rows of instance_a, instance_b, triangle_a, triangle_b and class, of which instances are numbers of
// geometries, and of the ends of segments.
nb::tuple bound_collide(Scene& scene, bool self, bool by_position, bool segments) {
    std::vector<std::array<uint, 5>> contacts;
    Contacts found = unlocked([&] {
        const Scene::Turn turn(scene);
        const ContactOptions options{.self = self,
                                     .shared = by_position ? SharedVertices::by_position : SharedVertices::by_index,
                                     .segments = segments};
        Contacts all = NarrowPhase(turn.accel().context()).find(turn.accel(), options);
        const std::vector<uint> numbers = scene.geometries();
        for (const TriangleContact& contact : all.list)
            contacts.push_back({numbers[contact.instance_a], numbers[contact.instance_b], contact.triangle_a,
                                contact.triangle_b, static_cast<uint>(contact.pair_class)});
        return all;
    });
    return nb::make_tuple(given<uint>(std::move(contacts), 5), given<double>(std::move(found.segments), 6));
}

// The closest hits of rays, judged by the reference in float64. Without rays, `count` are made: half of them random, a
// quarter aimed at vertices and a quarter at edges.
std::vector<HitClass> classes_of(Scene& scene, std::vector<Ray>& rays, std::size_t count, std::uint64_t seed) {
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
    return reference.classify(rays, turn.accel().closest_hits(rays, {.level = turn.level()}), by);
}

template <class Enum>
nb::str python_name(Enum value) {
    const std::string_view name = name_of(value);
    return nb::str(name.data(), name.size());
}

template <class T>
nb::dict bound_verify(Scene& scene, const RayArray<T>& array, const Vector& origin, std::size_t count,
                      std::uint64_t seed) {
    std::vector<Ray> rays = rays_of(rows_of(array, origin));
    std::vector<HitClass> classes = unlocked([&] { return classes_of(scene, rays, count, seed); });
    const HitClassCounts counted = twinray::count(classes);
    nb::dict counts, found;
    for (std::size_t i = 0; i < hit_class_count; ++i) counts[python_name(static_cast<HitClass>(i))] = counted.counts[i];
    found["counts"] = counts;
    found["faults"] = counted.faults_of_ours() + counted.faults_of_hardware();
    found["bound_95"] = counted.bound_95();
    found["classes"] = given<std::uint8_t>(std::move(classes));
    found["rays"] = given<float>(std::move(rays), 8);
    return found;
}

nb::object bound_sky_patches(const std::string& name) {
    std::vector<std::array<double, 4>> rows;
    for (const SkyPatch& patch : sky_patches(name))
        rows.push_back({patch.direction.x, patch.direction.y, patch.direction.z, patch.solid_angle});
    return given<double>(std::move(rows), 4);
}

nb::object bound_visible(Scene& scene, const Rows<float, 3>& points, const Rows<float, 3>& vectors,
                         const Rows<float, 3>& normals, float t_near, float t_far) {
    return given<std::uint8_t>(unlocked([&] {
        const Scene::Turn turn(scene);
        return visibility(turn.accel(), as<vec3>(points), as<vec3>(vectors), as<vec3>(normals),
                          {.t_near = t_near, .t_far = t_far});
    }));
}

// Computes on the device of the scene. `corner` and `size`: column and row.
nb::object bound_horizon(Scene& scene,
                         const nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>& heights,
                         std::array<uint, 2> corner, std::array<uint, 2> size, const Rows<float, 2>& ways,
                         HorizonMeasure measure, float lift, float curvature, float reach) {
    const HeightRaster raster{.heights = {heights.data(), heights.size()},
                              .columns = static_cast<uint>(heights.shape(1)),
                              .rows = static_cast<uint>(heights.shape(0))};
    const HorizonDesc desc{.corner = {corner[0], corner[1]},
                           .size = {size[0], size[1]},
                           .ways = {reinterpret_cast<const vec2*>(ways.data()), ways.shape(0)},
                           .measure = measure,
                           .lift = lift,
                           .curvature = curvature,
                           .reach = reach};
    return given<float>(unlocked([&] {
        const Scene::Turn turn(scene);
        return horizon(turn.accel().context(), raster, desc);
    }));
}

}  // namespace

void bind_analysis(nb::module_& m) {
    nb::class_<MatrixRows>(m, "ViewFactors")
        .def(
            "__init__",
            [](MatrixRows* to, Scene& scene, const std::vector<uint>& groups, bool both_sides, std::uint64_t rays,
               std::optional<double> target_error, std::uint32_t seed, const std::string& estimator) {
                const ViewFactorOptions options{
                    .sides = sides_of(both_sides), .rays = rays, .target_error = target_error, .seed = seed};
                unlocked([&] { new (to) MatrixRows(scene, groups, options, estimator); });
            },
            nb::keep_alive<1, 2>(), nb::arg("scene"), nb::arg("groups"), nb::arg("both_sides"), nb::arg("rays"),
            nb::arg("target_error").none(), nb::arg("seed"), nb::arg("estimator"))
        .def("count", &MatrixRows::count)
        .def("rows", &rows_of_matrix);
    nb::list hit_classes, pair_classes;
    for (std::size_t i = 0; i < hit_class_count; ++i) hit_classes.append(python_name(static_cast<HitClass>(i)));
    for (const PairClass each : all_pair_classes) pair_classes.append(python_name(each));
    m.attr("HIT_CLASSES") = nb::tuple(hit_classes);
    m.attr("PAIR_CLASSES") = nb::tuple(pair_classes);
    m.def("illumination", &bound_illumination);
    m.def("sky_light", &bound_sky_light);
    m.def("centroid", &bound_centroid);
    m.def("collide", &bound_collide);
    const auto unconverted = nb::arg("rays").noconvert();
    m.def("verify", &bound_verify<float>, nb::arg("scene"), unconverted, nb::arg("origin"), nb::arg("count"),
          nb::arg("seed"));
    m.def("verify", &bound_verify<double>, nb::arg("scene"), unconverted, nb::arg("origin"), nb::arg("count"),
          nb::arg("seed"));
    m.def("sky_patches", &bound_sky_patches);
    m.def("visible", &bound_visible);
    nb::enum_<HorizonMeasure>(m, "HorizonMeasure")
        .value("slope", HorizonMeasure::slope)
        .value("light", HorizonMeasure::light)
        .value("solid_angle", HorizonMeasure::solid_angle);
    m.def("horizon", &bound_horizon);
}

}  // namespace twinray::python
