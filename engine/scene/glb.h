// Writes scenes as glTF 2.0.
#pragma once

#include <twinray/scene.h>

namespace twinray {

// Points, and lines from one to the next, in world space; drawn without light.
struct GlbMarks {
    struct Vertex {
        dvec3 position;
        Rgb color;
    };
    std::vector<Vertex> points, lines;  // two vertices a line
};

// Writes the scene as glTF 2.0 in one file, each face in its colour (COLOR_0, linear light): `colors` by instance, then
// by triangle. Instances are nodes, below one that moves them if the scene's origin is not 0; those of one mesh that
// have the same colours share it. Faces keep their order; each has vertices of its own, and those with a vertex that is
// not finite, which glTF does not allow, are left out. Materials, textures, cameras and lights are not written. Throws
// Error naming the file, and for a wrong number of colours.
void write_glb(const std::filesystem::path& file, const Scene& scene, std::span<const Rgb> colors,
               const GlbMarks& marks = {});

}  // namespace twinray
