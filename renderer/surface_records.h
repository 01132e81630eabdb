// Makes the records that the kernels read from a Scene: plain data in, plain data out.
#pragma once

#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// An image of the scene as materials sample it.
struct SampledTexture {
    uint image;
    TextureOptions options;
    bool operator==(const SampledTexture&) const = default;
};

// The textures of a scene's materials, each once, in the order in which records name them.
struct TextureList {
    std::vector<SampledTexture> textures = {};

    // Adds the texture where it is not there; all zero for none.
    TextureSlot slot_of(const Texture& texture, bool is_srgb);
};

// Return unit vectors, 0 for one without a direction; empty if the mesh has none.
std::vector<vec3> unit_normals(const Mesh& mesh);
std::vector<vec4> unit_tangents(const Mesh& mesh);
// Adds the textures of the materials to the list.
std::vector<SurfaceMaterial> material_records(const Scene& scene, TextureList& textures);
// Does the same for the layers beyond the plain surface.
std::vector<LayeredMaterial> layered_records(const Scene& scene, TextureList& textures);

// Leaves references null.
SurfaceInstance instance_record(const Transform& transform);

// Returns LAYER_ bits of the layers that have an effect.
uint layers_of(const Material& material);

}  // namespace twinray::path_tracer
