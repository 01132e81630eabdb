// SPDX-License-Identifier: MIT
// .ply files. Assimp reads them too, but crashes on damaged headers and rounds numbers loosely.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "engine/core/error.h"
#include "engine/scene/importers.h"
#include "engine/scene/ply_header.h"
#include "engine/scene/polygon.h"

namespace twinray {
namespace {

// The values of the body, one after the other.
class PlyValues {
  public:
    PlyValues(const Bytes& bytes, const PlyHeader& header, const std::string& object)
        : bytes_(bytes), format_(header.format), position_(header.size), object_(object) {}

    double next(PlyType type) { return format_ == PlyHeader::Format::ascii ? next_word(type) : next_binary(type); }

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

    double next_word(PlyType type) {
        const auto is_space = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
        if (position_ == bytes_.size()) fail_truncated();
        const char* first = reinterpret_cast<const char*>(bytes_.data()) + position_;
        const char* last = reinterpret_cast<const char*>(bytes_.data()) + bytes_.size();
        if (*first == '+') ++first;
        // A float is rounded once, from its digits.
        const auto [end, value] = type == PlyType::f32 ? parsed<float>(first, last) : parsed<double>(first, last);
        if (!end || (end != last && !is_space(static_cast<std::uint8_t>(*end))))
            fail("'", object_, "': '", std::string(first, std::min(last, first + 20)), "' at byte ", position_,
                 " is not a number");
        position_ = static_cast<std::size_t>(end - reinterpret_cast<const char*>(bytes_.data()));
        return value;
    }

    template <class T>
    static std::pair<const char*, double> parsed(const char* first, const char* last) {
        T value = 0;
        const auto [end, error] = std::from_chars(first, last, value);
        if (error == std::errc::result_out_of_range) return {end, out_of_range(first, end)};
        return {error == std::errc() ? end : nullptr, static_cast<double>(value)};
    }

    // from_chars leaves the value alone beyond the type's range; what is too large is infinite, too small is 0.
    static double out_of_range(const char* first, const char* end) {
        const double value = std::strtod(std::string(first, end).c_str(), nullptr);
        return std::abs(value) < 1 ? 0.0 : std::copysign(static_cast<double>(INFINITY), value);
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

// Where a vertex property goes: 0-2 position, 3-5 normal, 6-7 texture coordinates, 8 nowhere.
std::size_t slot_of(const PlyProperty& property) {
    constexpr std::size_t nowhere = 8;
    if (property.count_type) return nowhere;
    const std::array<std::initializer_list<const char*>, nowhere> names = {
        {{"x"}, {"y"}, {"z"}, {"nx"}, {"ny"}, {"nz"}, {"u", "s", "texture_u"}, {"v", "t", "texture_v"}}};
    for (std::size_t i = 0; i < nowhere; ++i)
        if (is_any_of(property.name, names[i])) return i;
    return nowhere;
}

class PlyReader {
  public:
    PlyReader(const Bytes& bytes, std::string object)
        : object_(std::move(object)), header_(parse_ply_header(bytes, object_)), values_(bytes, header_, object_) {}

    Mesh read() {
        for (const PlyElement& element : header_.elements)
            if (element.name == "vertex")
                read_vertices(element);
            else
                read_faces(element);
        check_corners();
        triangulate();
        return std::move(mesh_);
    }

    std::size_t skipped() const { return skipped_; }

  private:
    void read_vertices(const PlyElement& element) {
        std::array<bool, 9> has{};
        std::vector<std::size_t> slots;
        for (const PlyProperty& property : element.properties) has[slots.emplace_back(slot_of(property))] = true;
        if (!has[0] || !has[1] || !has[2]) fail("'", object_, "': its vertices have no x, y and z");
        for (std::size_t i = 0; i < element.count; ++i) {
            std::array<float, 9> v{};
            for (std::size_t p = 0; p < slots.size(); ++p) v[slots[p]] = read_property(element.properties[p]);
            mesh_.positions.emplace_back(v[0], v[1], v[2]);
            if (has[3] && has[4] && has[5]) mesh_.normals.emplace_back(v[3], v[4], v[5]);
            if (has[6] && has[7]) mesh_.uvs.emplace_back(v[6], 1 - v[7]);  // v points up here and down in glTF
        }
    }

    float read_property(const PlyProperty& property) {
        if (!property.count_type) return static_cast<float>(values_.next(property.type));
        for (std::size_t left = values_.next_count(*property.count_type); left > 0; --left) values_.next(property.type);
        return 0;
    }

    // Any other element too, of which nothing is kept.
    void read_faces(const PlyElement& element) {
        for (std::size_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties)
                if (element.name == "face" && property.count_type &&
                    is_any_of(property.name, {"vertex_indices", "vertex_index"}))
                    read_polygon(property);
                else
                    read_property(property);
    }

    void read_polygon(const PlyProperty& property) {
        const std::size_t count = values_.next_count(*property.count_type);
        for (std::size_t i = 0; i < count; ++i) corners_.push_back(values_.next(property.type));
        corner_counts_.push_back(count);
    }

    // After all elements, since nothing says that the vertices come first.
    void check_corners() const {
        std::size_t at = 0;
        for (std::size_t face = 0; face < corner_counts_.size(); at += corner_counts_[face++])
            for (std::size_t i = 0; i < corner_counts_[face]; ++i)
                if (const double c = corners_[at + i];
                    !(c >= 0) || c >= static_cast<double>(mesh_.positions.size()) || c != std::floor(c))
                    fail("'", object_, "': face ", face, " has vertex index ", c, ", but there are only ",
                         mesh_.positions.size(), " vertices");
    }

    void triangulate() {
        std::size_t at = 0;
        for (const std::size_t count : corner_counts_) {
            std::vector<uint> polygon;
            for (std::size_t i = 0; i < count; ++i) polygon.push_back(static_cast<uint>(corners_[at + i]));
            at += count;
            if (count < 3) ++skipped_;
            if (count == 3) mesh_.triangles.emplace_back(polygon[0], polygon[1], polygon[2]);
            if (count <= 3) continue;
            const std::vector<uvec3> triangles = triangulate_polygon(mesh_.positions, polygon);
            mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
        }
    }

    std::string object_;
    PlyHeader header_;
    PlyValues values_;
    Mesh mesh_;
    std::vector<double> corners_;  // of all faces, unchecked
    std::vector<std::size_t> corner_counts_;
    std::size_t skipped_ = 0;
};

}  // namespace

Scene import_ply(const std::filesystem::path& file) {
    const Bytes bytes = read_packed_file(file);
    PlyReader reader(bytes, file.string());
    Scene scene;
    Mesh mesh = reader.read();
    mesh.name = file.stem().string();
    mesh.materials.assign(mesh.triangles.size(), 0);
    if (reader.skipped())
        scene.warnings.push_back(text("skipped ", reader.skipped(), " faces of fewer than 3 corners"));
    if (mesh.triangles.empty()) fail("'", file.string(), "': has ", mesh.positions.size(), " vertices but no faces");
    scene.instances.push_back({mesh.name, 0, {}});
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

}  // namespace twinray
