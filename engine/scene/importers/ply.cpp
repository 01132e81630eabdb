// SPDX-License-Identifier: MIT
// .ply files, text and binary, with faces or strips of triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <twinray/scene.h>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/importers/importers.h"
#include "engine/scene/importers/passed_over.h"
#include "engine/scene/importers/polygon.h"
#include "engine/scene/importers/words.h"
#include "engine/scene/local_origin.h"
#include "engine/scene/mesh.h"

namespace twinray {
namespace {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::f32;
    std::optional<PlyType> count_type;  // set: a list, which starts with its length
    std::size_t line = 0;               // of the header, from 1
};

struct PlyElement {
    std::string name;
    std::size_t count = 0, line = 0;
    std::vector<PlyProperty> properties;
};

// The elements that a header declares.
struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian };
    Format format = Format::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  // where the body starts
};

std::optional<PlyType> type_of(const std::string& name) {
    static const std::map<std::string, PlyType> types = {
        {"char", PlyType::i8},   {"int8", PlyType::i8},     {"uchar", PlyType::u8},   {"uint8", PlyType::u8},
        {"short", PlyType::i16}, {"int16", PlyType::i16},   {"ushort", PlyType::u16}, {"uint16", PlyType::u16},
        {"int", PlyType::i32},   {"int32", PlyType::i32},   {"uint", PlyType::u32},   {"uint32", PlyType::u32},
        {"float", PlyType::f32}, {"float32", PlyType::f32}, {"double", PlyType::f64}, {"float64", PlyType::f64}};
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

bool read_format(std::istringstream& words, PlyHeader& header) {
    std::string format;
    words >> format;
    if (format == "binary_little_endian") header.format = PlyHeader::Format::little_endian;
    if (format == "binary_big_endian") header.format = PlyHeader::Format::big_endian;
    return format == "ascii" || header.format != PlyHeader::Format::ascii;
}

bool read_element(std::istringstream& words, std::size_t line, PlyHeader& header) {
    PlyElement element;
    element.line = line;
    std::string count;
    words >> element.name >> count;
    if (count.empty() || count.size() > 12 || count.find_first_not_of("0123456789") != std::string::npos) return false;
    element.count = std::stoull(count);
    header.elements.push_back(std::move(element));
    return true;
}

bool read_property(std::istringstream& words, std::size_t line, PlyHeader& header) {
    PlyProperty property;
    property.line = line;
    std::string type, count_type;
    words >> type;
    if (type == "list") words >> count_type >> type;
    words >> property.name;
    if (header.elements.empty() || property.name.empty() || !type_of(type)) return false;
    property.type = *type_of(type);
    if (!count_type.empty()) {
        property.count_type = type_of(count_type);
        if (!property.count_type || *property.count_type >= PlyType::f32) return false;
    }
    header.elements.back().properties.push_back(std::move(property));
    return true;
}

bool read_line(const std::string& line, std::size_t number, PlyHeader& header) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") return read_format(words, header);
    if (keyword == "element") return read_element(words, number, header);
    if (keyword == "property") return read_property(words, number, header);
    // Blender 2.47 forgot the word "comment"; from the first element on, a line must be understood.
    return header.elements.empty() || keyword == "comment" || keyword == "obj_info";
}

// After this, no count makes a reader reserve more memory than the file's size justifies.
void check_counts(const PlyHeader& header, std::size_t body_size, const std::string& object) {
    for (const PlyElement& element : header.elements) {
        std::size_t least = element.properties.empty() ? 1 : 0;
        for (const PlyProperty& property : element.properties)
            least +=
                header.format == PlyHeader::Format::ascii ? 1 : size_of(property.count_type.value_or(property.type));
        if (element.count > body_size / least)
            fail("'", object, "': ", element.count, " elements '", element.name, "' do not fit into the ", body_size,
                 " bytes after the header");
    }
}

// Throws Error naming `object` and the line that it cannot parse, or the element that is larger than the file.
PlyHeader parse_ply_header(const Bytes& bytes, const std::string& object) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("ply") || text.size() < 4)
        fail("'", object, "': not a PLY file (it does not start with 'ply')");
    // All lines end as the first one does. If each were examined, a body after CR that begins with the byte 10 would
    // lose it.
    const std::size_t first_end = text.find_first_of("\r\n");
    const bool ends_in_cr = first_end != text.npos && text[first_end] == '\r' && text.substr(first_end + 1, 1) != "\n";
    const char line_end = ends_in_cr ? '\r' : '\n';
    PlyHeader header;
    for (std::size_t line_number = 1; header.size < text.size(); ++line_number) {
        const std::size_t end = std::min(text.find(line_end, header.size), text.size());
        const std::string line(trimmed(text.substr(header.size, end - header.size)));
        header.size = std::min(end + 1, text.size());
        if (line == "end_header") {
            check_counts(header, text.size() - header.size, object);
            return header;
        }
        if (!read_line(line, line_number, header))
            fail("'", object, "': PLY header line ", line_number, " '", line.substr(0, 60), "' is not understood");
    }
    fail("'", object, "': the PLY header has no end_header");
}

// The values of the body, one after the other.
class PlyValues {
  public:
    PlyValues(const Bytes& bytes, const PlyHeader& header, const std::string& object)
        : bytes_(bytes), format_(header.format), position_(header.size), object_(object) {}

    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word() : next_binary(type); }

    // The length of a list that the rest of the file may hold.
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

// The destination of a vertex property: 0-2 position, 3-5 normal, 6-7 texture coordinates, 8 nowhere.
constexpr std::size_t nowhere = 8;

std::size_t slot_of(const PlyProperty& property) {
    if (property.count_type) return nowhere;
    const std::array<std::initializer_list<const char*>, nowhere> names = {
        {{"x"}, {"y"}, {"z"}, {"nx"}, {"ny"}, {"nz"}, {"u", "s", "texture_u"}, {"v", "t", "texture_v"}}};
    for (std::size_t i = 0; i < nowhere; ++i)
        if (is_any_of(property.name, names[i])) return i;
    return nowhere;
}

bool holds_faces(const PlyElement& element) { return is_any_of(element.name, {"face", "tristrips"}); }

bool holds_corners(const PlyElement& element, const PlyProperty& property) {
    return holds_faces(element) && property.count_type && is_any_of(property.name, {"vertex_indices", "vertex_index"});
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
        return std::move(mesh_);
    }

    const dvec3& origin() const { return origin_; }
    std::vector<std::string> warnings() const {
        std::vector<std::string> sentences = cutter_.warnings("face");
        if (!passed_over_.empty())
            sentences.push_back("passed over elements and properties of the header: " + passed_over_.list());
        return sentences;
    }

  private:
    void read_vertices(const PlyElement& element) {
        std::array<bool, 9> has{};
        std::vector<std::size_t> slots;
        for (const PlyProperty& property : element.properties) {
            has[slots.emplace_back(slot_of(property))] = true;
            if (slots.back() == nowhere) passed_over_.add(property.name, property.line);
        }
        if (!has[0] || !has[1] || !has[2]) fail("'", object_, "': its vertices have no x, y and z");
        for (std::size_t i = 0; i < element.count; ++i) {
            std::array<double, 9> v{};
            for (std::size_t p = 0; p < slots.size(); ++p) v[slots[p]] = read_property(element.properties[p]);
            positions_.emplace_back(v[0], v[1], v[2]);
            if (has[3] && has[4] && has[5]) mesh_.normals.push_back(normal_or_none({v[3], v[4], v[5]}));
            if (has[6] && has[7]) mesh_.uvs.emplace_back(v[6], 1 - v[7]);  // v points up here and down in glTF
        }
    }

    double read_property(const PlyProperty& property) {
        if (!property.count_type) return values_.next(property.type);
        for (std::size_t left = values_.next_count(*property.count_type); left > 0; --left) values_.next(property.type);
        return 0;
    }

    // It also reads other elements, of which nothing is kept.
    void read_faces(const PlyElement& element) {
        const bool has_strips = element.name == "tristrips";
        if (!holds_faces(element)) passed_over_.add(element.name, element.line);
        for (const PlyProperty& property : element.properties)
            if (holds_faces(element) && !holds_corners(element, property))
                passed_over_.add(property.name, property.line);
        for (std::size_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties)
                if (!holds_corners(element, property))
                    read_property(property);
                else
                    has_strips ? read_strips(property) : read_polygon(property);
    }

    void read_polygon(const PlyProperty& property) {
        const std::size_t count = values_.next_count(*property.count_type);
        for (std::size_t i = 0; i < count; ++i) indices_.push_back(values_.next(property.type));
        vertex_counts_.push_back(count);
    }

    // -1 begins a new one. Every second triangle of a strip is turned, so that all face one way.
    void read_strips(const PlyProperty& property) {
        std::vector<double> strip;
        for (std::size_t left = values_.next_count(*property.count_type); left > 0; --left) {
            const double index = values_.next(property.type);
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
            for (const uvec3& t : cutter_.cut(outline, face))
                mesh_.triangles.emplace_back(index(t.x), index(t.y), index(t.z));
        }
    }

    std::string object_;
    PlyHeader header_;
    PlyValues values_;
    Mesh mesh_;
    dvec3 origin_ = dvec3(0);
    std::vector<dvec3> positions_;  // as the file has them
    std::vector<double> indices_;   // of all faces, unchecked
    std::vector<std::size_t> vertex_counts_;
    FaceCutter cutter_;
    PassedOver passed_over_;
};

}  // namespace

Scene import_ply(const std::filesystem::path& file, const std::optional<dvec3>& origin) {
    const Bytes bytes = read_packed_file(file);
    PlyReader reader(bytes, file.string());
    Scene scene;
    Mesh mesh = reader.read(origin);
    scene.origin = reader.origin();
    mesh.name = file.stem().string();
    mesh.materials.assign(mesh.triangles.size(), 0);
    scene.warnings = reader.warnings();
    if (mesh.triangles.empty()) fail("'", file.string(), "': has ", mesh.positions.size(), " vertices but no faces");
    scene.instances.push_back({mesh.name, 0, {}});
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

}  // namespace twinray
