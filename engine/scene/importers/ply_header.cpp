#include "engine/scene/importers/ply_header.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

bool read_format(std::string_view words, PlyHeader& header) {
    const std::string_view format = cut_word(words);
    if (format == "binary_little_endian") header.format = PlyHeader::Format::little_endian;
    if (format == "binary_big_endian") header.format = PlyHeader::Format::big_endian;
    return format == "ascii" || header.format != PlyHeader::Format::ascii;
}

bool read_element(std::string_view words, std::size_t line, PlyHeader& header) {
    PlyElement element;
    element.line = line;
    element.name = cut_word(words);
    const std::string count(cut_word(words));
    if (count.empty() || count.size() > 12 || count.find_first_not_of("0123456789") != std::string::npos) return false;
    element.count = std::stoull(count);
    header.elements.push_back(std::move(element));
    return true;
}

bool read_property(std::string_view words, std::size_t line, PlyHeader& header) {
    PlyProperty property;
    property.line = line;
    std::string_view type = cut_word(words), count_type;
    if (type == "list") count_type = cut_word(words), type = cut_word(words);
    property.name = cut_word(words);
    if (header.elements.empty() || property.name.empty() || !ply_type_of(type)) return false;
    property.type = *ply_type_of(type);
    if (!count_type.empty()) {
        property.count_type = ply_type_of(count_type);
        if (!property.count_type || *property.count_type >= PlyType::f16) return false;
    }
    header.elements.back().properties.push_back(std::move(property));
    return true;
}

bool read_line(std::string_view line, std::size_t number, PlyHeader& header) {
    const std::string_view keyword = cut_word(line);
    if (keyword == "format") return read_format(line, header);
    if (keyword == "element") return read_element(line, number, header);
    if (keyword == "property") return read_property(line, number, header);
    // A comment with a meaning: `comment TextureFile wall.png`.
    if (keyword == "comment" && cut_word(line) == "TextureFile" && !trimmed(line).empty())
        header.textures.emplace_back(trimmed(line));
    // Blender 2.47 forgot the word "comment"; from the first element on, a line must be understood.
    return header.elements.empty() || keyword == "comment" || keyword == "obj_info";
}

// Checks that no count makes anyone reserve more memory than the file vouches for.
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

std::optional<PlyType> ply_type_of(std::string_view name) {
    static const std::map<std::string_view, PlyType> types = {
        {"char", PlyType::i8},   {"int8", PlyType::i8},     {"uchar", PlyType::u8},    {"uint8", PlyType::u8},
        {"short", PlyType::i16}, {"int16", PlyType::i16},   {"ushort", PlyType::u16},  {"uint16", PlyType::u16},
        {"int", PlyType::i32},   {"int32", PlyType::i32},   {"uint", PlyType::u32},    {"uint32", PlyType::u32},
        {"int64", PlyType::i64}, {"uint64", PlyType::u64},  {"float16", PlyType::f16}, {"half", PlyType::f16},
        {"float", PlyType::f32}, {"float32", PlyType::f32}, {"double", PlyType::f64},  {"float64", PlyType::f64}};
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 11> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

PlyHeader parse_ply_header(const Bytes& bytes, const std::string& object) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("ply") || text.size() < 4)
        fail("'", object, "': not a PLY file (it does not start with 'ply')");
    // All lines end as the first one does. If each line decided for itself, a body after CR that begins with the byte
    // 10 would lose it.
    const std::size_t first_end = text.find_first_of("\r\n");
    const bool ends_in_cr = first_end != text.npos && text[first_end] == '\r' && text.substr(first_end + 1, 1) != "\n";
    const char line_end = ends_in_cr ? '\r' : '\n';
    PlyHeader header;
    for (std::size_t line_number = 1; header.size < text.size(); ++line_number) {
        const std::size_t end = std::min(text.find(line_end, header.size), text.size());
        const std::string_view line = trimmed(text.substr(header.size, end - header.size));
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

}  // namespace twinray
