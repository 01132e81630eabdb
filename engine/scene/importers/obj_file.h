// SPDX-License-Identifier: MIT
// What an .obj file says, before meshes are made of it.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "twinray/glsl/cpp.h"

namespace twinray {

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
    std::vector<vec3> normals;  // 0 for those that are no number
    std::vector<vec2> uvs;      // v upwards
    std::vector<FaceVertex> face_vertices;
    std::vector<Face> faces;
    // What `o` names, or `g` where no `o` is in force; empty before either.
    std::vector<std::string> part_names;
    std::vector<MaterialName> materials;
    std::vector<std::string> libraries;  // what each `mtllib` says
    std::vector<std::string> warnings;
};

// Throws Error naming `object` and the line that is wrong.
ObjFile parse_obj(std::string_view text, const std::string& object);

}  // namespace twinray
