// The declarations in the header of a .ply file.
#pragma once

#include "engine/core/files.h"

namespace twinray {

enum class PlyType { i8, u8, i16, u16, i32, u32, i64, u64, f16, f32, f64 };

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
    std::vector<std::string> textures;  // the pictures that lines `comment TextureFile` name
    std::size_t size = 0;               // the header's: the body starts there
};

// Returns the type of a name in headers, also for names from writers of NumPy arrays; nothing if the name is no type.
std::optional<PlyType> ply_type_of(std::string_view name);
std::size_t size_of(PlyType type);  // in a binary file, in bytes

// Throws Error naming `object` and the line that it does not understand, or the element that is larger than the file.
PlyHeader parse_ply_header(const Bytes& bytes, const std::string& object);

}  // namespace twinray
