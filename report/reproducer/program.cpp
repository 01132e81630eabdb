#include "report/reproducer/program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "engine/core/error.h"
#include "reproducer_query.spv.h"
#include "reproducer_trace_rchit.spv.h"
#include "reproducer_trace_rgen.spv.h"
#include "reproducer_trace_rmiss.spv.h"
#include "reproducer.c.h"
#include "validation/exact/exact_reference.h"
#include "validation/reference/error_bounds.h"
#include "validation/reference/geometry64.h"

namespace twinray::reproducer {
namespace {

// Returns a number in C.
std::string literal(double value, const char* suffix) {
    if (std::isinf(value)) return value > 0 ? "INFINITY" : "-INFINITY";
    if (value == std::nearbyint(value) && std::abs(value) < 1e6 && !(value == 0 && std::signbit(value)))
        return text(static_cast<long>(value));
    return text(std::hexfloat, value, suffix);
}
std::string literal(float value) { return literal(double{value}, "f"); }
std::string literals(const vec3& v) { return text(literal(v.x), ", ", literal(v.y), ", ", literal(v.z)); }
std::string literals(const Interval& i) { return text("{", literal(i.low, ""), ", ", literal(i.high, ""), "}"); }

std::string quoted(std::string words) {
    std::ranges::replace(words, '\n', ' ');
    return text(std::quoted(words));
}

// Writes a vertex; a comment has it in decimal if the code does not.
void put_vertex(std::ostream& out, const vec3& p) {
    const std::string numbers = literals(p);
    out << "    {" << numbers << "},";
    if (numbers.find('x') != std::string::npos) out << "  // " << p.x << ", " << p.y << ", " << p.z;
    out << '\n';
}

void put_meshes(std::ostream& out, const Scene& scene) {
    std::ostringstream triangles, instances;
    std::size_t first_vertex = 0, first_triangle = 0;
    out << "static const float vertices[][3] = {\n" << std::setprecision(9);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const vec3& p : mesh.positions) put_vertex(out, p);
        for (const uvec3& t : mesh.triangles)
            triangles << "    {" << t.x + first_vertex << ", " << t.y + first_vertex << ", " << t.z + first_vertex
                      << "},\n";
        instances << "    {" << first_triangle << ", " << mesh.triangles.size();
        const char* begin = ", {{{";
        for (const vec4& row : instance.transform.rows) {
            instances << begin << literals(vec3(row)) << ", " << literal(row.w);
            begin = "}, {";
        }
        instances << "}}}},\n";
        first_vertex += mesh.positions.size();
        first_triangle += mesh.triangles.size();
    }
    out << "};\nstatic const uint32_t triangles[][3] = {\n"
        << triangles.str() << "};\nstatic const Instance instances[] = {\n"
        << instances.str() << "};\n";
}

void put_right_answers(std::ostream& out, const RightAnswers& right) {
    out << "static const int is_miss_right = " << right.is_miss_right << ";\nstatic const RightHit right_hits[] = {\n";
    for (const RightHit& hit : right.hits)
        out << "    {" << hit.instance << ", " << hit.primitive << ", " << literals(hit.t) << ", " << literals(hit.u)
            << ", " << literals(hit.v) << "},\n";
    if (right.hits.empty()) out << "    {0, 0, {0, 0}, {0, 0}, {0, 0}},  // none\n";
    out << "};\nstatic const uint32_t right_hit_count = " << right.hits.size() << ";\n";
}

void put_shader(std::ostream& out, const ProgramShader& shader) {
    constexpr std::size_t words_a_line = 9;
    out << "static const uint32_t " << shader.name << "_spirv[] = {" << std::hex << std::setfill('0');
    for (std::size_t i = 0; i < shader.spirv.size(); ++i)
        out << (i % words_a_line == 0 ? "\n    0x" : " 0x") << std::setw(8) << shader.spirv[i] << ',';
    out << "\n};\n" << std::dec << std::setfill(' ');
}

std::string data_text(const ProgramData& data) {
    std::ostringstream out;
    out << "static const char found_on[] = " << quoted(data.found_on)
        << ";\nstatic const char expected[] = " << quoted(data.right.exact)
        << ";\nstatic const int by_pipeline = " << data.by_pipeline << ";\n";
    put_meshes(out, data.scene);
    const Ray& ray = data.ray;
    out << "static const float ray[8] = {" << literals(ray.origin) << ", /* t_min */ " << literal(ray.t_min) << ",\n"
        << "                             " << literals(ray.direction) << ", /* t_max */ " << literal(ray.t_max)
        << "};\n";
    put_right_answers(out, data.right);
    for (const ProgramShader& shader : program_shaders()) put_shader(out, shader);
    return out.str();
}

// Sets the range in which u and v name points within point_error of the ray: all numbers if the ray sees the triangle
// edge-on.
void set_barycentrics(RightHit& right, const TriangleBound& bound) {
    const dvec2 a = bound.vertices[1] - bound.vertices[0], b = bound.vertices[2] - bound.vertices[0],
                ray = -bound.vertices[0];
    const double area = cross2(a, b);
    right.u = right.v = {-unlimited, unlimited};
    const auto around = [](double value, double error) { return Interval{value - error, value + error}; };
    if (area == 0) return;
    right.u = around(cross2(ray, b) / area, bound.point_error * std::hypot(b.x, b.y) / std::abs(area));
    right.v = around(cross2(a, ray) / area, bound.point_error * std::hypot(a.x, a.y) / std::abs(area));
}

double middle(const Interval& i) { return std::isfinite(i.high - i.low) ? i.low + (i.high - i.low) / 2 : 0; }

bool is_right(const ReferenceScene& reference, const Ray& ray, const Hit& hit) {
    return !is_fault_of_hardware(class_of(reference, ray, hit));
}

// Returns the number in decimal, and as a short fraction if it has one.
std::string words_of(const exact::Rational& value) {
    const std::string fraction = value.get_str(), decimal = text(std::setprecision(17), exact::rounded(value));
    constexpr std::size_t most_digits = 20;
    return fraction.size() <= most_digits && fraction != decimal ? text(fraction, " = ", decimal) : decimal;
}

std::string words_of(const std::optional<exact::ClosestHit>& closest) {
    if (!closest) return "a miss";
    const char* where[] = {"inside it", "on its edge", "at its vertex"};
    const exact::Crossing& crossing = closest->crossing;
    std::string words =
        text("triangle ", closest->triangles[0].primitive, " of instance ", closest->triangles[0].instance,
             " at t = ", words_of(crossing.t), ", u = ", words_of(crossing.u), ", v = ", words_of(crossing.v), ", ",
             where[static_cast<std::size_t>(crossing.incidence)]);
    if (closest->triangles.size() > 1) words += text("; ", closest->triangles.size(), " triangles meet the ray there");
    return words;
}

}  // namespace

std::span<const ProgramShader> program_shaders() {
    static const std::array<ProgramShader, 4> shaders = {{{"query", reproducer_query_spirv},
                                                          {"raygen", reproducer_trace_rgen_spirv},
                                                          {"hit", reproducer_trace_rchit_spirv},
                                                          {"miss", reproducer_trace_rmiss_spirv}}};
    return shaders;
}

std::string program_text(const ProgramData& data) {
    std::string program = program_template;
    const std::size_t begin = program.find("// BEGIN OF DATA"), end = program.find("// END OF DATA");
    return program.replace(begin, end - begin, "// BEGIN OF DATA\n" + data_text(data));
}

HitClass class_of(const ReferenceScene& reference, const Ray& ray, const Hit& hit) {
    const exact::Reference exactly(reference);
    return *classify(reference, ray, {}, hit, [&](const Ray& r) { return exactly.rounded_hit(r); }).hardware;
}

bool RightHit::allows(const Hit& hit) const {
    return instance == hit.instance_index && primitive == hit.primitive_index && t.holds(hit.t) && u.holds(hit.u) &&
           v.holds(hit.v);
}

bool RightAnswers::allow(const Hit& hit) const {
    if (!hit.hit) return is_miss_right;
    return std::ranges::any_of(hits, [&](const RightHit& right) { return right.allows(hit); });
}

std::optional<RightHit> right_hit(const ReferenceScene& reference, const Ray& ray, uint instance, uint primitive) {
    const ErrorBounds bounds(ray, reference.placement(instance), Accelerator::hardware);
    const TriangleBound bound = bounds.bound(reference.geometry(instance).find(primitive)->vertices64());
    if (bound.margin < -bound.radius) return {};
    RightHit right{instance, primitive, {bound.t_low, bound.t_high}, {}, {}};
    set_barycentrics(right, bound);
    const float t = static_cast<float>(std::clamp(bound.t, bound.t_low, bound.t_high));
    const float u = static_cast<float>(middle(right.u)), v = static_cast<float>(middle(right.v));
    if (!is_right(reference, ray, {1, t, primitive, 0, u, v, instance, 0})) return {};
    return right;
}

RightAnswers right_answers(const ReferenceScene& reference, const Ray& ray) {
    RightAnswers right;
    right.exact = words_of(exact::Reference(reference).closest_hit(ray));
    right.is_miss_right = is_right(reference, ray, miss());
    for (uint instance = 0; instance < reference.instance_count(); ++instance)
        for (const ActiveTriangle& triangle : reference.geometry(instance).active())
            if (const auto hit = right_hit(reference, ray, instance, triangle.primitive)) right.hits.push_back(*hit);
    return right;
}

}  // namespace twinray::reproducer
