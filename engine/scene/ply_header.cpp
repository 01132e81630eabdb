// SPDX-License-Identifier: MIT
#include "engine/scene/ply_header.h"

#include <array>
#include <map>
#include <sstream>

#include "engine/core/error.h"

namespace twinray {
namespace {

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

bool read_element(std::istringstream& words, PlyHeader& header) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    if (count.empty() || count.size() > 12 || count.find_first_not_of("0123456789") != std::string::npos) return false;
    element.count = std::stoull(count);
    header.elements.push_back(std::move(element));
    return true;
}

bool read_property(std::istringstream& words, PlyHeader& header) {
    PlyProperty property;
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

bool read_line(const std::string& line, PlyHeader& header) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") return read_format(words, header);
    if (keyword == "element") return read_element(words, header);
    if (keyword == "property") return read_property(words, header);
    // Blender 2.47 forgot the word "comment"; from the first element on, a line must be understood.
    return header.elements.empty() || keyword == "comment" || keyword == "obj_info";
}

// So that no count makes anyone reserve more memory than the file vouches for.
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

}  // namespace

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

PlyHeader parse_ply_header(const Bytes& bytes, const std::string& object) {
    PlyHeader header;
    if (bytes.size() < 4 || std::string(bytes.begin(), bytes.begin() + 3) != "ply")
        fail("'", object, "': not a PLY file (it does not start with 'ply')");
    for (std::size_t line_number = 1; header.size < bytes.size(); ++line_number) {
        std::string line;
        while (header.size < bytes.size() && bytes[header.size] != '\n')
            line += static_cast<char>(bytes[header.size++]);
        ++header.size;
        if (line.ends_with('\r')) line.pop_back();
        if (line == "end_header") {
            const std::size_t body_size = bytes.size() - std::min(bytes.size(), header.size);
            check_counts(header, body_size, object);
            return header;
        }
        if (!read_line(line, header))
            fail("'", object, "': PLY header line ", line_number, " '", line.substr(0, 60), "' is not understood");
    }
    fail("'", object, "': the PLY header has no end_header");
}

}  // namespace twinray
