// Reads .obj files.
#include <algorithm>
#include <charconv>

#include "engine/core/error.h"
#include "engine/scene/importers/importers.h"
#include "engine/scene/importers/mtl.h"
#include "engine/scene/importers/faces.h"
#include "engine/scene/local_origin.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

// The contents of a file, before meshes are made from it.
struct ObjFile {
    static constexpr uint none = std::numeric_limits<uint>::max();

    struct FaceVertex {
        uint position, uv = none, normal = none;  // none: not given, or not in the file
    };
    struct Face {
        std::size_t line;
        std::size_t first_vertex, vertex_count;
        uint part, material;  // indices into part_names and materials; material may be none
    };
    struct MaterialName {
        std::string name;
        std::size_t line;  // where it is first used
    };

    std::vector<dvec3> positions;
    std::vector<vec3> normals;  // 0 for normals that are no number
    std::vector<vec2> uvs;      // v upwards
    std::vector<FaceVertex> face_vertices;
    std::vector<Face> faces;
    // The names from `o`, or from `g` if no `o` is in force; empty before either.
    std::vector<std::string> part_names;
    std::vector<MaterialName> materials;
    std::vector<std::string> libraries;  // the text of each `mtllib`
    std::vector<std::string> warnings;
};

// Throws Error naming `object` and the line with the fault.
class ObjParser {
  public:
    ObjParser(std::string_view text, std::string object) : lines_(text), object_(std::move(object)) {}

    ObjFile parse() {
        while (lines_.next()) read_line();
        check_corners();
        warn();
        return std::move(file_);
    }

  private:
    void read_line() {
        const std::string_view keyword = lines_.keyword();
        if (keyword == "v")
            read_position();
        else if (keyword == "vt")
            read_uv();
        else if (keyword == "vn")
            read_normal();
        else if (keyword == "f" || keyword == "fo")  // fo: the same, in files from before 1993
            read_face();
        else if (keyword == "usemtl")
            use_material();
        else if (keyword == "o" || keyword == "g")
            (keyword == "o" ? object_name_ : group_name_) = lines_.name(), part_ = ObjFile::none;
        else if (keyword == "mtllib")
            add_library(std::string(lines_.name()));
        else if (keyword == "p" || keyword == "l")
            ++points_and_lines_;
        else if (keyword != "s")  // smoothing by groups, without normals
            passed_over_.add(keyword, lines_.line());
    }

    template <class... Parts>
    [[noreturn]] void fail_here(const Parts&... parts) const {
        fail("'", object_, "', line ", lines_.line(), ": ", parts...);
    }

    struct Numbers {
        std::array<double, 8> values{};
        std::size_t count = 0;
    };

    // Values after the eighth are ignored.
    Numbers read_numbers(std::size_t least) const {
        Numbers numbers;
        std::string_view rest = lines_.numbers();
        for (std::string_view word = cut_word(rest); !word.empty() && numbers.count < 8; word = cut_word(rest)) {
            const std::optional<double> number = parse_number(word);
            if (!number) fail_here("'", word.substr(0, 20), "' is not a number");
            numbers.values[numbers.count++] = *number;
        }
        if (numbers.count < least)
            fail_here("'", lines_.keyword(), "' has ", numbers.count, " numbers; it needs ", least);
        return numbers;
    }

    void read_position() {
        const auto [v, count] = read_numbers(3);
        file_.positions.emplace_back(v[0], v[1], v[2]);
        has_colors_ |= count >= 6;
        has_weights_ |= count == 4 && v[3] != 1;
    }

    void read_uv() {
        const auto [v, count] = read_numbers(1);
        file_.uvs.emplace_back(v[0], v[1]);
    }

    void read_normal() {
        const auto [v, count] = read_numbers(3);
        file_.normals.push_back(normal_or_none({v[0], v[1], v[2]}));
    }

    void add_library(std::string names) {  // some files repeat it with every object
        if (std::ranges::find(file_.libraries, names) == file_.libraries.end())
            file_.libraries.push_back(std::move(names));
    }

    void use_material() {
        const std::string name(lines_.name());
        material_ = ObjFile::none;
        if (name.empty()) return;
        const auto [known, is_new] = material_numbers_.try_emplace(name, static_cast<uint>(material_numbers_.size()));
        if (is_new) file_.materials.push_back({name, lines_.line()});
        material_ = known->second;
    }

    // An object is one mesh, whatever its groups and materials are.
    void use_part() {
        const std::string& name = object_name_.empty() ? group_name_ : object_name_;
        const auto [known, is_new] = part_numbers_.try_emplace(name, static_cast<uint>(part_numbers_.size()));
        if (is_new) file_.part_names.push_back(name);
        part_ = known->second;
    }

    void read_face() {
        if (part_ == ObjFile::none) use_part();
        const std::size_t first = file_.face_vertices.size();
        std::string_view rest = lines_.numbers();
        for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest))
            file_.face_vertices.push_back(vertex_of(word));
        file_.faces.push_back({lines_.line(), first, file_.face_vertices.size() - first, part_, material_});
    }

    // Parses "5", "5/2", "5//3", "5/2/3"; and "5/", "5//", "5/2/", which some programs write.
    ObjFile::FaceVertex vertex_of(std::string_view word) const {
        const std::string_view whole = word;
        ObjFile::FaceVertex vertex{.position = cut_index(word, file_.positions.size(), whole)};
        if (vertex.position == ObjFile::none) fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        vertex.uv = cut_index(word, file_.uvs.size(), whole);
        vertex.normal = cut_index(word, file_.normals.size(), whole);
        if (!word.empty()) fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        return vertex;
    }

    // Cuts an index up to the next slash: from 1 on, or counted back from the last so far; none if it is left out.
    uint cut_index(std::string_view& word, std::size_t count, std::string_view whole) const {
        if (word.empty() || word.front() == '/') {
            word.remove_prefix(word.empty() ? 0 : 1);
            return ObjFile::none;
        }
        std::int64_t index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        word.remove_prefix(static_cast<std::size_t>(end - word.data()));
        if (error != std::errc{} || (!word.empty() && word.front() != '/'))
            fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        word.remove_prefix(word.empty() ? 0 : 1);
        const std::int64_t from_zero = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
        if (index == 0 || from_zero < 0 || from_zero >= std::int64_t{ObjFile::none})
            fail_here("'", whole.substr(0, 40), "' has index ", index, ", but there are ", count, " so far");
        return static_cast<uint>(from_zero);
    }

    // Called at the end, since faces may precede their vertices.
    void check_corners() {
        for (const ObjFile::Face& face : file_.faces)
            for (std::size_t i = 0; i < face.vertex_count; ++i) {
                ObjFile::FaceVertex& vertex = file_.face_vertices[face.first_vertex + i];
                if (vertex.position >= file_.positions.size())
                    fail("'", object_, "', line ", face.line, ": vertex index ", std::uint64_t(vertex.position) + 1,
                         " is out of range; there are ", file_.positions.size(), " vertices");
                forget_missing(vertex.uv, file_.uvs.size(), "texture coordinates", face.line);
                forget_missing(vertex.normal, file_.normals.size(), "normals", face.line);
            }
    }

    void forget_missing(uint& index, std::size_t count, const char* what, std::size_t line) {
        if (index == ObjFile::none || index < count) return;
        index = ObjFile::none;
        missing_.add(what, line);
    }

    void warn() {
        const auto warn_if = [&](bool is_so, const std::string& sentence) {
            if (is_so) file_.warnings.push_back(sentence);
        };
        warn_if(points_and_lines_ > 0, text("skipped ", points_and_lines_, " points and lines"));
        warn_if(has_colors_, "vertex colours are ignored");
        warn_if(has_weights_, "weights of vertices (the fourth number of 'v') are ignored");
        warn_if(!missing_.empty(), text("faces use what the file does not have: ", missing_.list()));
        warn_if(!passed_over_.empty(), text("passed over lines that begin with ", passed_over_.list()));
    }

    ObjLines lines_;
    std::string object_;
    ObjFile file_;
    std::map<std::string, uint> part_numbers_, material_numbers_;  // by name, in the order of their first use
    std::string object_name_, group_name_;
    uint part_ = ObjFile::none, material_ = ObjFile::none;
    std::size_t points_and_lines_ = 0;
    bool has_colors_ = false, has_weights_ = false;
    PassedOver missing_, passed_over_;
};

// Turns a parsed file into a Scene.
class ObjReader {
  public:
    ObjReader(const ObjFile& file, const std::filesystem::path& path, const std::optional<dvec3>& origin)
        : file_(file), path_(path) {
        scene_.warnings = file.warnings;
        scene_.origin = origin.value_or(choose_local_origin(bounds()));
        positions_ = local_positions(file.positions, scene_.origin);
    }

    Scene read() {
        read_materials();
        read_faces();
        for (std::size_t part = 0; part < parts_.size(); ++part) add_mesh(part);
        return std::move(scene_);
    }

  private:
    // Triangles of one mesh, three vertices each.
    struct Part {
        std::vector<ObjFile::FaceVertex> vertices;
        std::vector<uint> materials;
        bool has_uvs = false, has_normals = false;
    };

    // Returns the box of the vertices that faces use.
    Bounds64 bounds() const {
        Bounds64 bounds;
        for (const ObjFile::FaceVertex& vertex : file_.face_vertices) bounds.include(file_.positions[vertex.position]);
        return bounds;
    }

    void read_materials() {
        MtlReader library(scene_, path_.parent_path());
        for (const std::string& names : file_.libraries) library.read_files(names);
        for (const auto& [name, line] : file_.materials) materials_.push_back(library.index_of(name, line));
        library.warn_of_missing();
    }

    uint material_of(const ObjFile::Face& face) {
        if (face.material != ObjFile::none) return materials_[face.material];
        if (!default_material_) {
            default_material_ = static_cast<uint>(scene_.materials.size());
            scene_.materials.push_back(plain_material("default"));
        }
        return *default_material_;
    }

    void read_faces() {
        parts_.resize(file_.part_names.size());
        FaceCutter cutter;
        std::vector<dvec3> outline;
        for (const ObjFile::Face& face : file_.faces) {
            Part& part = parts_[face.part];
            const auto vertices = std::span(file_.face_vertices).subspan(face.first_vertex, face.vertex_count);
            outline.clear();
            for (const ObjFile::FaceVertex& vertex : vertices) {
                outline.push_back(file_.positions[vertex.position]);
                part.has_uvs |= vertex.uv != ObjFile::none;
                part.has_normals |= vertex.normal != ObjFile::none;
            }
            for (const uvec3& triangle : cutter.cut(outline, face.line)) {
                part.vertices.insert(part.vertices.end(),
                                     {vertices[triangle.x], vertices[triangle.y], vertices[triangle.z]});
                part.materials.push_back(material_of(face));
            }
        }
        for (std::string& sentence : cutter.warnings("line")) scene_.warnings.push_back(std::move(sentence));
    }

    void add_mesh(std::size_t index) {
        const Part& part = parts_[index];
        if (part.materials.empty()) return;
        Mesh mesh;
        mesh.name = file_.part_names[index].empty() ? path_.stem().string() : file_.part_names[index];
        mesh.materials = part.materials;
        for (const ObjFile::FaceVertex& vertex : part.vertices) {
            mesh.positions.push_back(positions_[vertex.position]);
            if (part.has_normals)
                mesh.normals.push_back(vertex.normal == ObjFile::none ? vec3(0) : file_.normals[vertex.normal]);
            if (part.has_uvs) {
                const vec2 uv = vertex.uv == ObjFile::none ? vec2(0) : file_.uvs[vertex.uv];
                mesh.uvs.emplace_back(uv.x, 1 - uv.y);  // v points up in the file and down in glTF and in Image
            }
        }
        scene_.instances.push_back({mesh.name, static_cast<uint>(scene_.meshes.size()), {}});
        scene_.meshes.push_back(weld_unindexed(std::move(mesh)));
    }

    const ObjFile& file_;
    const std::filesystem::path& path_;
    Scene scene_;
    std::vector<vec3> positions_;  // relative to the scene's origin
    std::vector<uint> materials_;  // of the file's materials: the scene's
    std::optional<uint> default_material_;
    std::vector<Part> parts_;
};

}  // namespace

Scene import_obj(const std::filesystem::path& path, const std::optional<dvec3>& origin) {
    const Bytes bytes = read_packed_file(path);
    const ObjFile file = ObjParser(text_of(bytes, path.string()), path.string()).parse();
    return ObjReader(file, path, origin).read();
}

}  // namespace twinray
