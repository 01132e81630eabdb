// SPDX-License-Identifier: MIT
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

}  // namespace twinray::reproducer
