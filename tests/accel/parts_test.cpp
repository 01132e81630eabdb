// Work that is cut into many submissions gives what it gives in one.
#include <twinray/analysis.h>
#include <twinray/queries.h>

#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

// The bytes of plain values, one after the other.
class Found {
  public:
    template <class... Values>
    void add(const Values&... values) {
        (append(values), ...);
    }
    bool operator==(const Found&) const = default;
    std::size_t size() const { return bytes_.size(); }

  private:
    template <class T>
    void append(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        const auto bytes = std::as_bytes(std::span(&value, 1));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    void append(const dvec3& p) { add(p.x, p.y, p.z); }
    void append(const Interval& interval) { add(interval.low, interval.high); }
    void append(const Hit& hit) {
        add(hit.hit, hit.t, hit.primitive_index, hit.custom_index, hit.u, hit.v, hit.instance_index, hit.flags);
    }
    template <class T>
    void append(const std::vector<T>& values) {
        for (const T& value : values) append(value);
    }
    std::vector<std::byte> bytes_;
};

using Work = std::function<void(Context&, Found&)>;

// Expects equal results without a limit on submissions, and with one that no work can keep, which takes at least
// `more` submissions more.
void expect_equal_in_parts(const Work& work, std::uint64_t more, ContextDesc desc = {}) {
    Found found[2];
    std::uint64_t submissions[2] = {};
    for (const std::size_t is_cut : {0u, 1u}) {
        desc.most_submission_seconds = is_cut ? 1e-9 : 0;
        const std::unique_ptr<Context> context = test::make_context(desc);
        if (!context) return;
        if (!context->properties().shader_float64) TWINRAY_LACKS("float64", "no float64");
        if (!missing_for_hardware(context->properties()).empty()) TWINRAY_LACKS("ray_tracing", "no ray tracing");
        work(*context, found[is_cut]);
        submissions[is_cut] = context->last_submission().value;
        for (const std::string& message : context->validation_messages()) ADD_FAILURE() << message;
    }
    EXPECT_GT(found[0].size(), 1000u);
    EXPECT_TRUE(found[0] == found[1]);
    EXPECT_GE(submissions[1], submissions[0] + more);
}

Scene scene_of_balls() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes = {make_icosphere(1), make_box(vec3(-0.5f), vec3(0.5f, 0.25f, 0.5f))};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> within(-2, 2);
    for (uint i = 0; i < 12; ++i)
        scene.instances.push_back(
            {"", i / 6, Transform::translation(vec3(within(random), within(random), within(random)))});
    return scene;
}

std::vector<dvec3> some_points() {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> within(-3, 3);
    std::vector<dvec3> points;
    for (int i = 0; i < 1500; ++i) points.push_back({within(random), within(random), within(random)});
    return points;
}

void trace(AbstractAccel& accel, Found& found) {
    push_scene(accel, scene_of_balls());
    const std::vector<Ray> rays = twinray::random_rays({vec3(-3), vec3(3)}, 2000, 4);
    found.add(accel.closest_hits(rays), accel.any_hits(rays));
    found.add(accel.closest_hits(rays, {.order = RayOrder::sorted}));
}

TEST(Parts, SoftwareTracesAndBuildsTheSame) {
    for (const Layout layout : all_layouts)
        expect_equal_in_parts(
            [&](Context& context, Found& found) {
                SwTlas accel(context, {.layout = layout, .compiles_in_background = false});
                trace(accel, found);
                found.add(AllHits(accel)(twinray::random_rays({vec3(-3), vec3(3)}, 1000, 5)).hits);
            },
            3 * 31 + 15 + 10);
}

TEST(Parts, HardwareTracesTheSame) {
    for (const bool use_ray_query : {true, false})
        expect_equal_in_parts(
            [](Context& context, Found& found) {
                HwTlas accel(context);
                trace(accel, found);
            },
            3 * 31, {.use_ray_query = use_ray_query});
}

TEST(Parts, LightIsTheSame) {
    expect_equal_in_parts(
        [](Context& context, Found& found) {
            const Scene scene = scene_of_balls();
            SwTlas accel(context);
            push_scene(accel, scene);
            const Faces faces(context, scene);
            const RayGridDesc grid{.direction = dvec3(0.25, -1, 0.5), .side = 45};
            for (const LitArea& lit : illuminate(accel, faces, {.grid = grid}).groups)
                found.add(lit.hits, lit.area, lit.interval);
            const Centroid seen = centroid(accel, scene, {.grid = grid, .keeps_points = true});
            found.add(seen.points, *seen.mean);
            for (const Received& received : sky_light(accel, faces, dvec3(0, 1, 0), {.samples = 33}).faces)
                found.add(received.value, received.interval);
        },
        2 * 30 + 100);
}

TEST(Parts, ViewFactorsAreTheSame) {
    expect_equal_in_parts(
        [](Context& context, Found& found) {
            const Scene scene = scene_of_balls();
            SwTlas accel(context);
            push_scene(accel, scene);
            const Faces faces(context, scene);
            const ViewFactorOptions options{.grouping = FaceGrouping::instance, .rays = 1024};
            const PairExchanges pairs = exchanges_of_pairs(accel, faces, options, PairEstimator::automatic);
            for (const KnownExchange& known : pairs.known)
                found.add(known.i, known.j, known.flow, known.low, known.high);
            ViewFactors factors(accel, faces, options);
            for (const ViewFactorRow& row : factors.rows(0, factors.row_count()))
                for (const ViewFactor& factor : row.factors)
                    found.add(factor.target, factor.value, factor.low, factor.high);
        },
        50);
}

TEST(Parts, PointsFindTheSame) {
    expect_equal_in_parts(
        [](Context& context, Found& found) {
            PointQuery query(context);
            const Scene scene = scene_of_balls();
            query.set(scene);
            const std::vector<dvec3> points = some_points();
            for (const ClosestPoint& at : query.closest(points))
                found.add(at.position, at.distance, at.instance, at.triangle);
            for (const NearTriangle& near : query.within(points, 0.5))
                found.add(near.point, near.instance, near.triangle, near.distance);
            found.add(query.winding_numbers(points));
        },
        3 * 23);
}

TEST(Parts, CollisionsAreTheSame) {
    expect_equal_in_parts(
        [](Context& context, Found& found) {
            const Scene scene = scene_of_balls();
            for (const TriangleContact& contact : NarrowPhase(context).find(scene).list)
                found.add(contact.instance_a, contact.instance_b, contact.triangle_a, contact.triangle_b,
                          contact.pair_class);
            SwTlas accel(context);
            push_scene(accel, scene);
            BroadPhase broad_phase(context);
            for (const InstancePair& pair : broad_phase.instance_pairs(accel)) found.add(pair.a, pair.b);
            found.add(broad_phase.count(accel));
        },
        10);
}

}  // namespace
}  // namespace twinray
