#include "validation/exact/exact_reference.h"

#include "validation/reference/error_bounds.h"

namespace twinray::exact {
namespace {

// The inverse of a placement's linear part, by cofactors.
struct Inverse {
    std::array<Vector, 3> rows;

    explicit Inverse(const Placement64& placement) {
        const Vector a = vector_of(placement.to_world[0]), b = vector_of(placement.to_world[1]),
                     c = vector_of(placement.to_world[2]);  // columns
        rows = {cross(b, c), cross(c, a), cross(a, b)};
        const Rational determinant = dot(a, rows[0]);
        for (Vector& row : rows) row = {row.x / determinant, row.y / determinant, row.z / determinant};
    }
    Vector operator*(const Vector& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
};

// The closest of all candidates in the ray's open interval.
struct Search {
    Rational t_min;
    std::optional<Rational> t_max;  // nothing: infinity
    std::optional<ClosestHit> best = {};
    double t_limit;  // not below the best t, or t_max

    explicit Search(const Ray& ray) : t_min(std::max(0.0, double{ray.t_min})), t_limit(ray.t_max) {
        if (std::isfinite(ray.t_max)) t_max = Rational(ray.t_max);
    }

    void offer(const Crossing& crossing, TriangleId triangle) {
        if (crossing.t <= t_min || (t_max && crossing.t >= *t_max)) return;
        if (best && crossing.t > best->crossing.t) return;
        if (best && crossing.t == best->crossing.t) {
            if (triangle < best->triangles.front()) best->crossing = crossing;
            best->triangles.insert(std::ranges::lower_bound(best->triangles, triangle), triangle);
            return;
        }
        best = {crossing, {triangle}};
        t_limit = std::min(t_limit, std::nextafter(rounded(crossing.t), INFINITY));
    }
};

std::array<Vector, 3> from_origin(const Line& line, const Triangle64& triangle) {
    return {vector_of(triangle[0]) - line.origin, vector_of(triangle[1]) - line.origin,
            vector_of(triangle[2]) - line.origin};
}

std::array<Rational, 3> edge_values(const Vector& direction, const std::array<Vector, 3>& vertices) {
    const auto& [a, b, c] = vertices;
    return {dot(direction, cross(b, c)), dot(direction, cross(c, a)), dot(direction, cross(a, b))};
}

}  // namespace

Line object_line(const Ray& ray, const Placement64& placement) {
    const Line line{vector_of(ray.origin), vector_of(ray.direction)};
    if (placement.is_identity) return line;
    const Inverse inverse(placement);
    return {inverse * (line.origin - vector_of(placement.offset)), inverse * line.direction};
}

std::optional<ClosestHit> Reference::closest_hit(const Ray& ray) const {
    if (!is_traceable(ray)) return std::nullopt;
    Search search(ray);
    for (const uint instance : reference_.instances_near(ray)) {
        const Geometry64& geometry = reference_.geometry(instance);
        const ErrorBounds bounds(ray, reference_.placement(instance), Accelerator::reference);
        const Line line = object_line(ray, reference_.placement(instance));
        geometry.visit(bounds.slabs(bounds.max_radius(geometry.bounds())), std::max(0.0, double{ray.t_min}),
                       search.t_limit, [&](const ActiveTriangle& triangle) {
                           if (const auto met = crossing(line, triangle.vertices64()))
                               search.offer(*met, {instance, triangle.primitive});
                           return true;
                       });
    }
    return search.best;
}

ReferenceHit Reference::rounded_hit(const Ray& ray) const { return to_float64(closest_hit(ray), reference_); }

std::optional<ClosestHit> Reference::closest_hit_brute_force(const Ray& ray) const {
    if (!is_traceable(ray)) return std::nullopt;
    Search search(ray);
    for (uint instance = 0; instance < reference_.instance_count(); ++instance) {
        const Line line = object_line(ray, reference_.placement(instance));
        for (const ActiveTriangle& triangle : reference_.geometry(instance).active())
            if (const auto met = crossing(line, triangle.vertices64()))
                search.offer(*met, {instance, triangle.primitive});
    }
    return search.best;
}

ReferenceHit to_float64(const std::optional<ClosestHit>& hit, const ReferenceScene& reference) {
    if (!hit) return {};
    const auto [instance, primitive] = hit->triangles.front();
    const Crossing& at = hit->crossing;
    return {true,
            rounded(at.t),
            rounded(at.u),
            rounded(at.v),
            primitive,
            instance,
            reference.options(instance).custom_index,
            at.along == reference.options(instance).flip_facing};
}

double rounded(const Rational& value) {
    const double toward_zero = value.get_d();  // mpq_get_d truncates
    const double away = std::nextafter(toward_zero, value < 0 ? -INFINITY : INFINITY);
    if (!std::isfinite(away)) return toward_zero;
    const Rational middle = (Rational(toward_zero) + Rational(away)) / 2;
    if (value == middle) return std::bit_cast<std::uint64_t>(toward_zero) % 2 == 0 ? toward_zero : away;
    return abs(value) < abs(middle) ? toward_zero : away;
}

std::array<Rational, 3> edge_values(const Line& line, const Triangle64& triangle) {
    return edge_values(line.direction, from_origin(line, triangle));
}

std::optional<Crossing> crossing(const Line& line, const Triangle64& triangle) {
    const std::array<Vector, 3> vertices = from_origin(line, triangle);
    const std::array<Rational, 3> values = edge_values(line.direction, vertices);
    const auto count = [&](int sign) {
        return std::ranges::count_if(values, [&](const Rational& value) { return sgn(value) == sign; });
    };
    if (count(-1) > 0 && count(1) > 0) return std::nullopt;
    const Rational sum = values[0] + values[1] + values[2];
    if (sum == 0) return std::nullopt;
    const Vector normal = cross(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    const Rational along = dot(normal, line.direction);
    return Crossing{dot(normal, vertices[0]) / along, values[1] / sum, values[2] / sum,
                    static_cast<Incidence>(count(0)), along > 0};
}

}  // namespace twinray::exact
