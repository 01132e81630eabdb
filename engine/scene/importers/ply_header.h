// SPDX-License-Identifier: MIT
// What the header of a PLY file declares.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/bytes.h"

namespace twinray {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t size_of(PlyType type);

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

struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian };
    Format format = Format::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  // where the body starts
};

// Throws Error naming `object` and the line that it does not understand, or the element that is larger than the file.
PlyHeader parse_ply_header(const Bytes& bytes, const std::string& object);

}  // namespace twinray
