// The kernels that a scene's materials need: materials with the same needs are of one kind, which has a kernel of its
// own for shading.
#pragma once

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// Each kind costs a pipeline and 4 bytes per ray in flight.
constexpr std::size_t most_material_kinds = 4;

// Returns by material whether an instance shows it.
std::vector<bool> used_materials(const Scene& scene);

// The features of a shading kernel that materials can need.
constexpr uint material_needs[] = {PT_HAS_ALPHA, PT_HAS_TEXTURES,   PT_HAS_GLASS,  PT_HAS_SPECULAR, PT_HAS_COAT,
                                   PT_HAS_SHEEN, PT_HAS_ANISOTROPY, PT_HAS_VOLUME, PT_HAS_COLORS,   PT_HAS_SECOND_UVS};

// Returns whether it may be a smooth wall without thickness somewhere, which light passes straight on.
bool may_be_pane(const Material& material);
// Returns whether it may be glass that is no such wall somewhere.
bool may_be_other_glass(const Material& material);

// Returns a bit for each of material_needs: 1 << PT_HAS_ALPHA and the like. Colors, which belong to meshes, have none.
uint needs_of(const Material& material);

struct MaterialKinds {
    std::vector<uint> needs;  // by kind: all that its materials need
    std::vector<uint> of;     // by material: its kind, 0 where nothing uses it
    uint all_needs() const;   // the needs of all kinds together
};
// Returns the kinds of the materials that triangles use; if a light has a texture, all kinds have the need for it.
// Beyond most_material_kinds, the kinds that differ least become one.
MaterialKinds kinds_of(const Scene& scene);

// Returns "textures, glass", for people.
std::string name_of_needs(uint needs);

}  // namespace twinray::path_tracer
