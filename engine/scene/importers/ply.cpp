// Reads .ply files, text and binary, with faces or strips of triangles.
#include <algorithm>
#include <tuple>
#include <type_traits>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/interruption.h"
#include "engine/scene/images.h"
#include "engine/scene/importers/importers.h"
#include "engine/scene/importers/ply_header.h"
#include "engine/scene/importers/faces.h"
#include "engine/scene/importers/words.h"
#include "engine/scene/local_origin.h"

namespace twinray {
namespace {

// The values of the body, one after the other.
class PlyValues {
  public:
    PlyValues(const Bytes& bytes, const PlyHeader& header, const std::string& object)
        : bytes_(bytes), format_(header.format), position_(header.size), object_(object) {}

    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word() : next_binary(type); }

    // Returns the length of a list that the rest of the file may hold.
    std::size_t next_count(PlyType type) {
        const double count = next(type);
        if (!(count >= 0) || count > static_cast<double>(bytes_.size() - position_) || count != std::floor(count))
            fail("'", object_, "': a PLY list claims ", count, " entries at byte ", position_);
        return static_cast<std::size_t>(count);
    }

  private:
    double next_binary(PlyType type) {
        const std::size_t size = size_of(type);
        if (size > bytes_.size() - position_) fail_truncated();
        std::array<std::uint8_t, 8> raw{};
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position_), size, raw.begin());
        if (format_ == PlyHeader::Format::big_endian) std::reverse(raw.begin(), raw.begin() + static_cast<int>(size));
        position_ += size;
        switch (type) {
            case PlyType::i8: return from<std::int8_t>(raw);
            case PlyType::u8: return from<std::uint8_t>(raw);
            case PlyType::i16: return from<std::int16_t>(raw);
            case PlyType::u16: return from<std::uint16_t>(raw);
            case PlyType::i32: return from<std::int32_t>(raw);
            case PlyType::u32: return from<std::uint32_t>(raw);
            case PlyType::i64: return from<std::int64_t>(raw);
            case PlyType::u64: return from<std::uint64_t>(raw);
            case PlyType::f16: return glm::unpackHalf1x16(static_cast<std::uint16_t>(raw[0] | raw[1] << 8));
            case PlyType::f32: return from<float>(raw);
            case PlyType::f64: return from<double>(raw);
        }
        return 0;
    }

    template <class T>
    static double from(const std::array<std::uint8_t, 8>& raw) {
        T value;
        std::memcpy(&value, raw.data(), sizeof value);
        return static_cast<double>(value);
    }

    // Returns all digits of the number, even if its type has fewer.
    double next_word() {
        const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
        std::string_view rest = text.substr(position_);
        const std::string_view word = cut_word(rest);
        if (word.empty()) fail_truncated();
        const std::optional<double> number = parse_number(word);
        if (!number)
            fail("'", object_, "': '", word.substr(0, 20), "' at byte ", word.data() - text.data(), " is not a number");
        position_ = text.size() - rest.size();
        return *number;
    }

    [[noreturn]] void fail_truncated() const { fail("'", object_, "': the PLY body is truncated"); }

    const Bytes& bytes_;
    PlyHeader::Format format_;
    std::size_t position_;
    std::string object_;
};

bool is_any_of(const std::string& name, std::initializer_list<const char*> names) {
    return std::ranges::find(names, name) != names.end();
}

// Vertex properties go to these slots: 0-2 position, 3-5 normal, 6-7 texture coordinates, 8-11 colour, 12 nowhere.
constexpr std::size_t nowhere = 12;

std::size_t slot_of(const PlyProperty& property) {
    using Slots = std::map<std::string_view, std::size_t>;
    static const Slots slots = {{"x", 0},         {"y", 1},
                                {"z", 2},         {"nx", 3},
                                {"ny", 4},        {"nz", 5},
                                {"u", 6},         {"s", 6},
                                {"texture_u", 6}, {"v", 7},
                                {"t", 7},         {"texture_v", 7},
                                {"red", 8},       {"diffuse_red", 8},
                                {"green", 9},     {"diffuse_green", 9},
                                {"blue", 10},     {"diffuse_blue", 10},
                                {"alpha", 11},    {"diffuse_alpha", 11}};
    const auto found = slots.find(property.name);
    return property.count_type || found == slots.end() ? nowhere : found->second;
}

bool holds_faces(const PlyElement& element) { return is_any_of(element.name, {"face", "tristrips"}); }

bool holds_corners(const PlyElement& element, const PlyProperty& property) {
    return holds_faces(element) && property.count_type && is_any_of(property.name, {"vertex_indices", "vertex_index"});
}

bool is_color(const PlyProperty& property) { return !property.count_type && slot_of(property) / 4 == 2; }

// Returns whether the property holds two coordinates for each corner of a polygon.
bool holds_uvs(const PlyElement& element, const PlyProperty& property) {
    return element.name == "face" && property.count_type && property.name == "texcoord";
}

// Returns whether the property tells which of the header's pictures a face shows.
bool holds_texture(const PlyElement& element, const PlyProperty& property) {
    return element.name == "face" && !property.count_type && property.name == "texnumber";
}

// Converts a colour to [0, 1]: integers are shares of the largest, and all are sRGB.
float color_of(double value, PlyType type) {
    const double most = type == PlyType::u8 ? 255 : type == PlyType::u16 ? 65535 : 1;
    return static_cast<float>(std::clamp(value / most, 0.0, 1.0));
}

class PlyReader {
  public:
    PlyReader(const Bytes& bytes, std::string object)
        : object_(std::move(object)), header_(parse_ply_header(bytes, object_)), values_(bytes, header_, object_) {}

    Mesh read(const std::optional<dvec3>& wanted_origin) {
        for (const PlyElement& element : header_.elements)
            if (element.name == "vertex")
                read_vertices(element);
            else
                read_faces(element);
        check_corners();
        origin_ = wanted_origin.value_or(choose_local_origin(bounds()));
        mesh_.positions = local_positions(positions_, origin_);
        triangulate();
        if (!corner_uvs_.empty()) split_vertices();
        return std::move(mesh_);
    }

    // The pictures that the file names, in the order of Mesh::materials.
    const std::vector<std::string>& textures() const { return header_.textures; }

    const dvec3& origin() const { return origin_; }
    std::vector<std::string> warnings() const {
        std::vector<std::string> sentences = cutter_.warnings("face");
        if (!passed_over_.empty())
            sentences.push_back("passed over elements and properties of the header: " + passed_over_.list());
        return sentences;
    }

  private:
    void read_vertices(const PlyElement& element) {
        std::array<bool, nowhere + 1> has{};
        std::vector<std::size_t> slots;
        for (const PlyProperty& property : element.properties) {
            has[slots.emplace_back(slot_of(property))] = true;
            if (slots.back() == nowhere) passed_over_.add(property.name, property.line);
        }
        const bool has_colors = has[8] && has[9] && has[10];
        const bool shows_colors = has_colors && header_.textures.empty();  // a picture takes precedence
        for (const PlyProperty& property : element.properties)
            if (is_color(property) && !shows_colors) passed_over_.add("colours", property.line);
        if (!has[0] || !has[1] || !has[2]) fail("'", object_, "': its vertices have no x, y and z");
        for (std::size_t i = 0; i < element.count; ++i) {
            interruption_.look();
            std::array<double, nowhere + 1> v{};
            v[11] = 1;
            for (std::size_t p = 0; p < slots.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                const double value = read_property(property);
                v[slots[p]] = is_color(property) ? color_of(value, property.type) : value;
            }
            positions_.emplace_back(v[0], v[1], v[2]);
            if (has[3] && has[4] && has[5]) mesh_.normals.push_back(normal_or_none({v[3], v[4], v[5]}));
            if (has[6] && has[7]) mesh_.uvs.emplace_back(v[6], 1 - v[7]);  // v points up here and down in glTF
            if (shows_colors) mesh_.colors.push_back(linear_color(v[8], v[9], v[10], v[11]));
        }
    }

    static vec4 linear_color(double red, double green, double blue, double alpha) {
        const auto linear = [](double value) { return linear_of_srgb(static_cast<float>(value)); };
        return {linear(red), linear(green), linear(blue), static_cast<float>(alpha)};
    }

    double read_property(const PlyProperty& property) {
        if (!property.count_type) return values_.next(property.type);
        for (std::size_t left = values_.next_count(*property.count_type); left > 0; --left) values_.next(property.type);
        return 0;
    }

    // Reads faces; other elements are read but not kept.
    void read_faces(const PlyElement& element) {
        const bool has_strips = element.name == "tristrips";
        if (!holds_faces(element)) passed_over_.add(element.name, element.line);
        const bool has_uvs = std::ranges::any_of(
            element.properties, [&](const PlyProperty& property) { return holds_uvs(element, property); });
        for (const PlyProperty& property : element.properties)
            if (holds_faces(element) && !holds_corners(element, property) && !holds_uvs(element, property) &&
                !holds_texture(element, property))
                passed_over_.add(is_color(property) ? "colours" : property.name, property.line);
        for (std::size_t i = 0; i < element.count; ++i) {
            interruption_.look();
            std::vector<double> uvs;
            double texture = 0;
            for (const PlyProperty& property : element.properties)
                if (holds_uvs(element, property))
                    uvs = read_list(property);
                else if (holds_texture(element, property))
                    texture = read_property(property);
                else if (!holds_corners(element, property))
                    read_property(property);
                else
                    has_strips ? read_strips(property) : read_polygon(property);
            if (has_uvs) add_corner_uvs(uvs);
            textures_of_faces_.resize(vertex_counts_.size(), texture);
        }
    }

    std::vector<double> read_list(const PlyProperty& property) {
        std::vector<double> values;
        for (std::size_t left = values_.next_count(*property.count_type); left > 0; --left)
            values.push_back(values_.next(property.type));
        return values;
    }

    // Adds coordinates of the corners read since; a face may have none, or another number than it has corners.
    void add_corner_uvs(const std::vector<double>& uvs) {
        const std::size_t first = corner_uvs_.size();
        const bool fits = uvs.size() == 2 * (indices_.size() - first);
        for (std::size_t i = 0; i < indices_.size() - first; ++i)
            corner_uvs_.push_back(fits ? vec2(uvs[2 * i], 1 - uvs[2 * i + 1]) : vec2(0));
    }

    void read_polygon(const PlyProperty& property) {
        const std::size_t count = values_.next_count(*property.count_type);
        for (std::size_t i = 0; i < count; ++i) indices_.push_back(values_.next(property.type));
        vertex_counts_.push_back(count);
    }

    // Reads strips; -1 begins a new one. Every second triangle of a strip is turned, so that all face one way.
    void read_strips(const PlyProperty& property) {
        std::vector<double> strip;
        for (const double index : read_list(property)) {
            if (index == -1) {
                strip.clear();
                continue;
            }
            strip.push_back(index);
            const std::size_t n = strip.size();
            if (n < 3) continue;
            const bool is_turned = n % 2 == 0;
            indices_.insert(indices_.end(),
                            {strip[n - 3], strip[is_turned ? n - 1 : n - 2], strip[is_turned ? n - 2 : n - 1]});
            vertex_counts_.push_back(3);
        }
    }

    // It runs after all elements, since vertices need not come first.
    void check_corners() const {
        std::size_t at = 0;
        for (std::size_t face = 0; face < vertex_counts_.size(); at += vertex_counts_[face++])
            for (std::size_t i = 0; i < vertex_counts_[face]; ++i)
                if (const double c = indices_[at + i];
                    !(c >= 0) || c >= static_cast<double>(positions_.size()) || c != std::floor(c))
                    fail("'", object_, "': face ", face, " has vertex index ", c, ", but there are only ",
                         positions_.size(), " vertices");
    }

    // Returns the box of the vertices that faces use.
    Bounds64 bounds() const {
        Bounds64 bounds;
        for (const double index : indices_) bounds.include(positions_[static_cast<std::size_t>(index)]);
        return bounds;
    }

    void triangulate() {
        std::size_t first = 0;
        std::vector<dvec3> outline;
        for (std::size_t face = 0; face < vertex_counts_.size(); first += vertex_counts_[face++]) {
            const auto index = [&](std::size_t i) { return static_cast<uint>(indices_[first + i]); };
            outline.clear();
            for (std::size_t i = 0; i < vertex_counts_[face]; ++i) outline.push_back(positions_[index(i)]);
            for (const uvec3& t : cutter_.cut(outline, face)) {
                mesh_.triangles.emplace_back(index(t.x), index(t.y), index(t.z));
                mesh_.materials.push_back(texture_of(face));
                if (!corner_uvs_.empty())
                    uvs_.insert(uvs_.end(),
                                {corner_uvs_[first + t.x], corner_uvs_[first + t.y], corner_uvs_[first + t.z]});
            }
        }
    }

    // Returns the picture of a face; the first one if the face has none, or one that the header does not name.
    uint texture_of(std::size_t face) const {
        const double number = textures_of_faces_[face];
        return number > 0 && number < static_cast<double>(header_.textures.size()) ? static_cast<uint>(number) : 0;
    }

    // Makes a vertex for each position and texture coordinates that meet in a corner.
    void split_vertices() {
        std::map<std::tuple<uint, float, float>, uint> vertices;
        std::vector<uint> sources;
        std::vector<vec2> uvs;
        for (std::size_t i = 0; i < uvs_.size(); ++i) {
            uint& corner = mesh_.triangles[i / 3][static_cast<int>(i % 3)];
            const auto [known, is_new] =
                vertices.try_emplace({corner, uvs_[i].x, uvs_[i].y}, static_cast<uint>(sources.size()));
            if (is_new) sources.push_back(corner), uvs.push_back(uvs_[i]);
            corner = known->second;
        }
        const auto pick = [&sources](auto& values) {
            if (values.empty()) return;
            std::remove_reference_t<decltype(values)> all;
            for (const uint source : sources) all.push_back(values[source]);
            values = std::move(all);
        };
        pick(mesh_.positions), pick(mesh_.normals), pick(mesh_.colors);
        mesh_.uvs = std::move(uvs);
    }

    std::string object_;
    PlyHeader header_;
    PlyValues values_;
    Mesh mesh_;
    dvec3 origin_ = dvec3(0);
    std::vector<dvec3> positions_;  // as the file has them
    std::vector<double> indices_;   // of all faces, unchecked
    std::vector<std::size_t> vertex_counts_;
    std::vector<double> textures_of_faces_;
    std::vector<vec2> corner_uvs_;  // as indices_; empty: faces have none
    std::vector<vec2> uvs_;         // three a triangle, where faces have some
    FaceCutter cutter_;
    PassedOver passed_over_;
    LoopInterruption interruption_;
};

// Adds the pictures that a file names, each as a material.
void add_textures(Scene& scene, const std::vector<std::string>& names, const std::filesystem::path& folder) {
    for (const std::string& name : names) {
        Material material{.name = name, .metallic = 0};
        material.base_color_texture.image = static_cast<std::int32_t>(scene.images.size());
        try {
            scene.images.push_back(
                decode_image(read_file(folder / platform::path_of(name)), text("picture '", name, "'")));
        } catch (const Error& e) {
            scene.warnings.push_back(text(e.what(), "; picture '", name, "' is shown as a checkerboard"));
            scene.images.push_back(checkerboard_image(name));
        }
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace

Scene import_ply(const std::filesystem::path& file, const std::optional<dvec3>& origin) {
    const Bytes bytes = read_packed_file(file);
    PlyReader reader(bytes, file.string());
    Scene scene;
    Mesh mesh = reader.read(origin);
    scene.origin = reader.origin();
    mesh.name = file.stem().string();
    scene.warnings = reader.warnings();
    if (!mesh.uvs.empty())
        add_textures(scene, reader.textures(), file.parent_path());
    else
        for (const std::string& name : reader.textures())
            scene.warnings.push_back(
                text("picture '", name, "' is not shown: the file has no texture coordinates; save it as OBJ or glTF"));
    if (scene.materials.empty()) mesh.materials.assign(mesh.triangles.size(), 0);
    if (!mesh.colors.empty()) scene.materials.push_back({.name = "colours of vertices", .metallic = 0});
    if (mesh.triangles.empty()) fail("'", file.string(), "': has ", mesh.positions.size(), " vertices but no faces");
    scene.instances.push_back({mesh.name, 0, {}});
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

}  // namespace twinray
