// Reads .stl files, binary and text. A facet's normal follows from its vertices and is not read, whatever it is.
#include <algorithm>

#include "engine/core/error.h"
#include "engine/scene/importers/importers.h"
#include "engine/scene/importers/mtl.h"
#include "engine/scene/importers/faces.h"
#include "engine/scene/local_origin.h"

namespace twinray {
namespace {

struct StlSolid {
    std::string name;
    std::vector<dvec3> vertices;  // three a triangle
};

struct StlFile {
    std::vector<StlSolid> solids;
    std::vector<std::string> warnings;
};

// A file has 80 bytes of anything, a count, and so many facets: normal, vertices, two bytes of anything.
constexpr std::size_t HEADER_SIZE = 84, FACET_SIZE = 50;

std::size_t facets_that_fit(const Bytes& bytes) {
    return bytes.size() < HEADER_SIZE ? 0 : (bytes.size() - HEADER_SIZE) / FACET_SIZE;
}

std::uint32_t stated_count(const Bytes& bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= HEADER_SIZE) std::memcpy(&count, bytes.data() + HEADER_SIZE - sizeof count, sizeof count);
    return count;
}

// Binary headers may also begin with "solid". Four characters are a count that no text is long enough for.
bool is_binary(const Bytes& bytes) {
    return bytes.size() >= HEADER_SIZE && stated_count(bytes) <= facets_that_fit(bytes);
}

StlFile parse_binary(const Bytes& bytes) {
    const std::size_t count = stated_count(bytes), end = HEADER_SIZE + count * FACET_SIZE;
    StlFile file;
    std::vector<dvec3>& vertices = file.solids.emplace_back().vertices;
    vertices.reserve(3 * count);
    for (std::size_t facet = 0; facet < count; ++facet) {
        vec3 read[3];
        std::memcpy(read, bytes.data() + HEADER_SIZE + facet * FACET_SIZE + sizeof(vec3), sizeof read);
        vertices.insert(vertices.end(), std::begin(read), std::end(read));
    }
    if (end < bytes.size())
        file.warnings.push_back(text("ignored ", bytes.size() - end, " bytes after the last triangle"));
    return file;
}

class StlTextParser {
  public:
    StlTextParser(std::string_view text, std::string object) : rest_(text), object_(std::move(object)) {}

    StlFile parse() {
        while (!rest_.empty()) {
            ++line_;
            std::string_view line = cut_line(rest_);
            read_line(lowered(cut_word(line)), line);
        }
        end_facet();
        for (std::string& sentence : cutter_.warnings("line")) file_.warnings.push_back(std::move(sentence));
        if (!passed_over_.empty()) file_.warnings.push_back("passed over lines that begin with " + passed_over_.list());
        return std::move(file_);
    }

  private:
    void read_line(const std::string& keyword, std::string_view rest) {
        if (keyword == "vertex") {
            read_vertex(rest);
        } else if (keyword == "solid") {
            end_facet();
            file_.solids.push_back({std::string(trimmed(rest)), {}});
        } else if (keyword == "facet" || keyword == "endfacet") {
            end_facet();
        } else if (!keyword.empty() && keyword != "outer" && keyword != "endloop" && !keyword.starts_with("end")) {
            passed_over_.add(keyword, line_);
        }
    }

    void read_vertex(std::string_view rest) {
        dvec3 point;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = cut_word(rest);
            const std::optional<double> number = parse_number(word);
            if (!number)
                fail("'", object_, "', line ", line_, ": '", word.substr(0, 20), "' is not a number of a vertex");
            point[i] = *number;
        }
        facet_.push_back(point);
    }

    void end_facet() {
        if (facet_.empty()) return;
        std::vector<dvec3>& vertices = file_.solids.back().vertices;
        for (const uvec3& triangle : cutter_.cut(facet_, line_))
            for (int i = 0; i < 3; ++i) vertices.push_back(facet_[triangle[i]]);
        facet_.clear();
    }

    std::string_view rest_;
    std::string object_;
    std::size_t line_ = 0;
    StlFile file_;
    std::vector<dvec3> facet_;
    FaceCutter cutter_;
    PassedOver passed_over_;
};

StlFile parse_stl(const Bytes& bytes, const std::string& object) {
    if (is_binary(bytes)) return parse_binary(bytes);
    const std::string_view whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (whole.find('\0') != whole.npos && bytes.size() >= HEADER_SIZE)
        fail("'", object, "': it says that it holds ", stated_count(bytes), " triangles, but ends after ",
             facets_that_fit(bytes));
    std::string_view text = text_of(bytes, object), start = text;
    if (lowered(cut_word(start)) != "solid")
        fail("'", object, "': not an STL file (it does not begin with 'solid', and is not a binary one)");
    return StlTextParser(text, object).parse();
}

}  // namespace

Scene import_stl(const std::filesystem::path& path, const std::optional<dvec3>& origin) {
    const Bytes bytes = read_packed_file(path);
    StlFile file = parse_stl(bytes, path.string());
    Scene scene;
    scene.warnings = std::move(file.warnings);
    Bounds64 bounds;
    for (const StlSolid& solid : file.solids)
        for (const dvec3& vertex : solid.vertices) bounds.include(vertex);
    scene.origin = origin.value_or(choose_local_origin(bounds));
    scene.materials.push_back(plain_material("default"));
    for (const StlSolid& solid : file.solids) {
        if (solid.vertices.empty()) continue;
        Mesh mesh;
        mesh.name = solid.name.empty() ? path.stem().string() : solid.name;
        mesh.positions = local_positions(solid.vertices, scene.origin);
        mesh.materials.assign(solid.vertices.size() / 3, 0);
        scene.instances.push_back({mesh.name, static_cast<uint>(scene.meshes.size()), {}});
        scene.meshes.push_back(weld_unindexed(std::move(mesh)));
    }
    return scene;
}

}  // namespace twinray
