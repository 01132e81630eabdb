// Triangles near points, checked against every triangle in float64. The GPU answers; no accelerator takes part.
#include "report/suite/sections.h"

#include <numbers>

#include <twinray/queries.h>
#include "engine/core/parallel.h"
#include "validation/reference/geometry64.h"

namespace twinray::suite {
namespace {

std::vector<dvec3> random_points(std::size_t count, double size, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto one = [&] { return (static_cast<double>(random() >> 11) * 0x1p-52 - 1) * size; };
    std::vector<dvec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = one(), y = one();
        points.emplace_back(x, y, one());
    }
    return points;
}

double distance_to(const Mesh& mesh, const uvec3& t, const dvec3& point) {
    return distance_to_triangle(corners_of(mesh, t), point);
}
double nearest_of_all(const Mesh& mesh, const dvec3& point) {
    double nearest = INFINITY;
    for (const uvec3& t : mesh.triangles) nearest = std::min(nearest, distance_to(mesh, t, point));
    return nearest;
}

// Adds the case's record of one question about many points, with medians of times.
void add_errors(CaseRun& run, const Values& params, const std::string& metric, std::vector<double> errors,
                std::vector<double> times, std::uint64_t wrong, const std::string& what) {
    Record record = query_record(run, "f64");
    record.params = params;
    record.n = errors.size();
    record.error = error_figures(metric, std::move(errors), 0x1p-53);
    record.time = time_figures("ns_per_point", std::move(times));
    add_checked(run, record, wrong, what);
}

// Relative errors may be as large as the effect of some roundings of the coordinates on a distance.
void measure_nearest(CaseRun& run, const Mesh& mesh, const std::vector<dvec3>& points, const Values& params) {
    PointQuery query(query_context(run));
    query.set(std::vector<MeshView>{mesh}, std::vector<MeshInstance>{{0, {}}});
    std::vector<ClosestPoint> found;
    const std::vector<double> times = ns_each(5, points.size(), [&] { found = query.closest(points); });
    const std::size_t step =
        std::max<std::size_t>(1, points.size() * mesh.triangles.size() / run.amount(5'000'000, 2'000'000'000));
    std::vector<double> errors((points.size() + step - 1) / step), slack(errors.size());
    parallel_for(errors.size(), [&](std::size_t i) {
        const dvec3& point = points[i * step];
        const ClosestPoint& of = found[i * step];
        const double known = nearest_of_all(mesh, point);
        const double of_named =
            of.is_found ? distance_to(mesh, mesh.triangles[of.triangle], point) : static_cast<double>(INFINITY);
        errors[i] = std::max(std::abs(of.distance - known), of_named - known) / known;
        slack[i] = 0x1p-49 * (1 + length(point)) / known;
    });
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) wrong += !(errors[i] <= slack[i]);
    add_errors(run, params, "relative", errors, times, wrong, "another triangle is nearer");
}

void sizes(CaseRun& run) {
    const std::vector<dvec3> points = random_points(run.amount(10'000, 1'000'000), 1.5, run.seed());
    for (const uint subdivisions : {1u, 2u, 3u, 5u}) {
        const Mesh ball = make_icosphere(subdivisions);
        measure_nearest(run, ball, points, {{"triangles", ball.triangles.size()}});
    }
}

void points_far_away(CaseRun& run) {
    for (const double distance : {1e3, 1e9, 1e15})
        measure_nearest(run, make_icosphere(3), random_points(run.amount(2'000, 100'000), distance, run.seed()),
                        {{"distance", distance}});
}

void on_the_surface(CaseRun& run) {
    const Mesh ball = make_icosphere(4);
    std::vector<dvec3> points(ball.positions.begin(), ball.positions.end());
    const std::size_t vertices = points.size();
    for (const uvec3& t : ball.triangles) points.push_back((points[t.x] + points[t.y]) * 0.5);
    PointQuery query(query_context(run));
    query.set(std::vector<MeshView>{ball}, std::vector<MeshInstance>{{0, {}}});
    const std::vector<ClosestPoint> found = query.closest(points);
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) wrong += !(found[i].distance <= (i < vertices ? 0 : 0x1p-52));
    Record record = query_record(run, "analytic");
    record.n = points.size();
    add_checked(run, record, wrong,
                "a vertex is away from its triangle, or the middle of an edge by more than rounding");
}

void distances_scaled(CaseRun& run) {
    Mesh soup = make_soup(500, static_cast<uint>(run.seed()), 0.2f);
    for (vec3& p : soup.positions) p = (p + 16.0f) - 16.0f;  // so that denormals hold them after scaling
    const std::vector<dvec3> points = random_points(run.amount(1'000, 100'000), 2, run.seed());
    PointQuery query(query_context(run));
    const std::vector<MeshInstance> instance = {{0, {}}};
    query.set(std::vector<MeshView>{soup}, instance);
    const std::vector<ClosestPoint> of_one = query.closest(points);
    for (const int exponent : {-120, -60, 60, 120}) {
        Mesh other = soup;
        for (vec3& p : other.positions)
            for (int axis = 0; axis < 3; ++axis) p[axis] = std::ldexp(p[axis], exponent);
        std::vector<dvec3> others = points;
        for (dvec3& p : others) p *= std::ldexp(1.0, exponent);
        query.set(std::vector<MeshView>{other}, instance);
        const std::vector<ClosestPoint> found = query.closest(others);
        std::uint64_t wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            wrong += found[i].triangle != of_one[i].triangle ||
                     found[i].distance != std::ldexp(of_one[i].distance, exponent);
        Record record = query_record(run, "invariance");
        record.params = {{"scale", text("2^", exponent)}};
        record.n = points.size();
        add_checked(run, record, wrong, "another triangle, or another distance, than at a scale of 1");
    }
}

void radius(CaseRun& run) {
    const Mesh ball = make_icosphere(3);
    const std::vector<dvec3> points = random_points(run.amount(300, 10'000), 1.5, run.seed());
    PointQuery query(query_context(run));
    query.set(std::vector<MeshView>{ball}, std::vector<MeshInstance>{{0, {}}});
    const std::vector<NearTriangle> near = query.within(points, 0.4);
    std::size_t next = 0;
    std::uint64_t wrong = 0, count = 0;
    for (uint i = 0; i < points.size(); ++i)
        for (uint t = 0; t < ball.triangles.size(); ++t) {
            const double distance = distance_to(ball, ball.triangles[t], points[i]);
            const bool is_listed = next < near.size() && near[next].point == i && near[next].triangle == t;
            next += is_listed;
            count += is_listed;
            if (std::abs(distance - 0.4) > 0x1p-48) wrong += is_listed != (distance < 0.4);
        }
    Record record = query_record(run, "f64");
    record.n = points.size() * ball.triangles.size();
    record.results = {{"found", count}};
    add_checked(run, record, wrong + (near.size() - next),
                "a triangle within the radius is missing, or one beyond is listed");
}

// Lines along +x from lattice points meet edges, vertices and whole faces of lattice boxes.
void sides(CaseRun& run) {
    const Mesh box = make_box(vec3(-2), vec3(2));
    const int n = static_cast<int>(run.amount(6, 24));
    std::vector<dvec3> points;
    for (int i = 0; i < (2 * n + 1) * (2 * n + 1) * (2 * n + 1); ++i)
        points.push_back(
            (dvec3(i % (2 * n + 1), i / (2 * n + 1) % (2 * n + 1), i / ((2 * n + 1) * (2 * n + 1))) - double(n)) *
            (3.0 / n));
    PointQuery query(query_context(run));
    const std::vector<MeshInstance> twice = {{0, {}}, {0, Transform::translation(vec3(1, 0, 0))}};
    query.set(std::vector<MeshView>{box}, twice);
    const std::vector<int> found = query.winding_numbers(points);
    std::uint64_t wrong = 0, checked = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto size = [](const dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
        const double first = size(points[i]), second = size(points[i] - dvec3(1, 0, 0));
        if (first == 2 || second == 2) continue;  // on a face
        ++checked;
        wrong += found[i] != (first < 2) + (second < 2);
    }
    Record record = query_record(run, "analytic");
    record.n = checked;
    record.results = {{"host_decided", query.host_decided()}};
    add_checked(run, record, wrong, "another winding number than the number of boxes around the point");
}

void signed_by_spheres(CaseRun& run) {
    std::vector<dvec3> points = random_points(run.amount(2'000, 200'000), 1.5, run.seed());
    std::erase_if(points, [](const dvec3& p) { return length(p) > 0.75 && length(p) < 1; });  // their sign is unknown
    for (const uint subdivisions : {1u, 2u, 3u, 4u}) {
        const Mesh ball = make_icosphere(subdivisions);
        PointQuery query(query_context(run));
        query.set(std::vector<MeshView>{ball}, std::vector<MeshInstance>{{0, {}}});
        std::vector<double> found, errors;
        const std::vector<double> times = ns_each(5, points.size(), [&] { found = query.signed_distances(points); });
        std::uint64_t wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double size = nearest_of_all(ball, points[i]), known = length(points[i]) < 1 ? -size : size;
            errors.push_back(std::abs(found[i] - known) / size);
            wrong += !(errors.back() <= 0x1p-49 * (1 + length(points[i])) / size);
        }
        add_errors(run, {{"triangles", ball.triangles.size()}}, "relative", errors, times, wrong,
                   "another distance, or another side");
    }
}

// Computes the winding number by Van Oosterom and Strackee (1983), summed in long double.
double winding_number(const Mesh& mesh, const dvec3& point) {
    using Vector = Vec<3, long double>;
    long double sum = 0;
    for (const uvec3& t : mesh.triangles) {
        const Vector a = Vector(mesh.positions[t.x]) - Vector(point), b = Vector(mesh.positions[t.y]) - Vector(point),
                     c = Vector(mesh.positions[t.z]) - Vector(point);
        const long double la = length(a), lb = length(b), lc = length(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return static_cast<double>(sum / (4 * std::numbers::pi_v<long double>));
}

Mesh upper_half(Mesh ball) {
    std::erase_if(ball.triangles, [&](const uvec3& t) {
        return ball.positions[t.x].z + ball.positions[t.y].z + ball.positions[t.z].z <= 0;
    });
    return ball;
}

// Returns random points, points beside edges, and points as far as coordinates may be.
std::vector<dvec3> points_about(const Mesh& mesh, CaseRun& run) {
    std::vector<dvec3> points = random_points(run.amount(1'000, 100'000), 1.5, run.seed());
    for (std::size_t i = 0; i < mesh.triangles.size() && i < 200; ++i) {
        const uvec3& t = mesh.triangles[i];
        const dvec3 middle = (dvec3(mesh.positions[t.x]) + dvec3(mesh.positions[t.y])) * 0.5;
        points.insert(points.end(), {middle * 1.001, middle * 0.999});
    }
    for (const double far : {1e10, 1e40, 1e70}) points.insert(points.end(), {dvec3(far, 1, 2), dvec3(0, -far, far)});
    return points;
}

void winding_of_open_meshes(CaseRun& run) {
    for (const uint subdivisions : {1u, 2u, 3u, 4u}) {
        const Mesh half = upper_half(make_icosphere(subdivisions));
        const std::vector<dvec3> points = points_about(half, run);
        PointQuery query(query_context(run));
        query.set(std::vector<MeshView>{half}, std::vector<MeshInstance>{{0, {}}});
        std::vector<double> found, errors(points.size());
        const std::vector<double> times =
            ns_each(3, points.size(), [&] { found = query.generalized_winding_numbers(points); });
        parallel_for(points.size(),
                     [&](std::size_t i) { errors[i] = std::abs(found[i] - winding_number(half, points[i])); });
        const double border =
            8 * std::ldexp(1.0, static_cast<int>(subdivisions));  // at least the number of edges without a neighbour
        std::uint64_t wrong = 0;
        for (const double error : errors) wrong += !(error <= 0x1p-50 * (border + 16));
        add_errors(run, {{"triangles", half.triangles.size()}}, "absolute", errors, times, wrong,
                   "off by more than 2^-50 times the number of edges without a neighbour");
    }
}

}  // namespace

std::vector<SuiteCase> distance_cases() {
    const std::string error = "relative error of the distance, time";
    return {
        {"D01", "nearest triangles of spheres", error, "no other triangle is nearer", sizes},
        {"D02", "points up to 10^15 away", error, "no other triangle is nearer", points_far_away},
        {"D03", "points at vertices and on edges", "distances", "0 at vertices, rounding on edges", on_the_surface},
        {"D04", "the scene 2^-120 to 2^120 as large", "triangles, distances", "the same, scaled", distances_scaled},
        {"D05", "all triangles within a radius", "those that are listed", "as all triangles one by one", radius},
        {"D06", "winding numbers on a lattice", "numbers", "as many boxes as are around the point", sides},
        {"D07", "signed distances of spheres", error, "the distance and the side, within rounding", signed_by_spheres},
        {"D08", "winding numbers of open half spheres, beside edges and up to 10^70 away", "absolute error, time",
         "2^-50 times the number of edges without a neighbour", winding_of_open_meshes},
    };
}

}  // namespace twinray::suite
