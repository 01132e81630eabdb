#include "renderer/material_kinds.h"

#include <algorithm>
#include <bit>

#include "renderer/surface_records.h"

namespace twinray::path_tracer {
namespace {

constexpr std::pair<uint, uint> needs_of_layers[] = {{LAYER_SPECULAR, PT_HAS_SPECULAR},
                                                     {LAYER_COAT, PT_HAS_COAT},
                                                     {LAYER_SHEEN, PT_HAS_SHEEN},
                                                     {LAYER_ANISOTROPY, PT_HAS_ANISOTROPY},
                                                     {LAYER_VOLUME, PT_HAS_VOLUME}};

// Returns by material whether an instance of a mesh that `counts` shows it.
template <class Counts>
std::vector<bool> materials_shown(const Scene& scene, const Counts& counts) {
    std::vector<bool> used(scene.materials.size());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (!counts(mesh)) continue;
        if (instance.material) used[*instance.material] = true;
        for (std::size_t i = 0; !instance.material && i < mesh.triangles.size(); ++i) used[mesh.material(i)] = true;
    }
    return used;
}

uint needs_of_texture(const Texture& texture) {
    if (texture.image < 0) return 0;
    return 1u << PT_HAS_TEXTURES | uint{texture.uv_set == 1} << PT_HAS_SECOND_UVS;
}

// Returns the needs of every kind: each kernel samples all lights, some of which may have textures or be transparent.
uint needs_of_lights(const Scene& scene, const std::vector<bool>& used, const std::vector<bool>& colored) {
    uint needs = 0;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!used[i] || largest(material.emission) <= 0) continue;
        const bool is_transparent = material.alpha_mode != AlphaMode::opaque;
        if (is_transparent) needs |= 1u << PT_HAS_ALPHA;
        needs |= needs_of_texture(material.emission_texture);
        if (is_transparent) needs |= needs_of_texture(material.base_color_texture);
        if (is_transparent && colored[i]) needs |= 1u << PT_HAS_COLORS;
    }
    return needs;
}

bool is_glass(const Material& material) {
    const bool is_metal = material.metallic >= 1 && material.metallic_roughness_texture.image < 0;
    return material.transmission > 0 && !is_metal && !material.unlit;
}

bool is_smooth(const Material& material) { return material.roughness * material.roughness < SMOOTH_ALPHA; }

uint index_of(std::vector<uint>& kinds, uint needs) {
    const auto found = std::find(kinds.begin(), kinds.end(), needs);
    if (found == kinds.end()) kinds.push_back(needs);
    return static_cast<uint>(std::find(kinds.begin(), kinds.end(), needs) - kinds.begin());
}

// Returns the two kinds whose union has the fewest needs that one of them lacks.
std::pair<std::size_t, std::size_t> closest(const std::vector<uint>& kinds) {
    std::pair<std::size_t, std::size_t> best{0, 1};
    for (std::size_t i = 0; i < kinds.size(); ++i)
        for (std::size_t j = i + 1; j < kinds.size(); ++j)
            if (std::popcount(kinds[i] ^ kinds[j]) < std::popcount(kinds[best.first] ^ kinds[best.second]))
                best = {i, j};
    return best;
}

void merge(MaterialKinds& kinds, std::size_t remaining, std::size_t removed) {
    kinds.needs[remaining] |= kinds.needs[removed];
    kinds.needs.erase(kinds.needs.begin() + static_cast<std::ptrdiff_t>(removed));
    for (uint& kind : kinds.of) {
        if (kind == removed) kind = static_cast<uint>(remaining);
        if (kind > removed) --kind;
    }
}

}  // namespace

std::vector<bool> used_materials(const Scene& scene) {
    return materials_shown(scene, [](const Mesh&) { return true; });
}

bool may_be_pane(const Material& material) {
    const bool may_be_smooth = is_smooth(material) || material.metallic_roughness_texture.image >= 0;
    return is_glass(material) && material.thickness <= 0 && may_be_smooth;
}

bool may_be_other_glass(const Material& material) {
    return is_glass(material) && (material.thickness > 0 || !is_smooth(material) || material.anisotropy > 0);
}

uint needs_of(const Material& material) {
    uint needs = 0;
    if (material.alpha_mode != AlphaMode::opaque) needs |= 1u << PT_HAS_ALPHA;
    for (const Texture* texture : textures_of(material)) needs |= needs_of_texture(*texture);
    if (material.transmission > 0) needs |= 1u << PT_HAS_GLASS;
    for (const auto& [layer, need] : needs_of_layers)
        if (layers_of(material) & layer) needs |= 1u << need;
    return needs;
}

uint MaterialKinds::all_needs() const {
    uint all = 0;
    for (const uint kind : needs) all |= kind;
    return all;
}

MaterialKinds kinds_of(const Scene& scene) {
    MaterialKinds kinds;
    const std::vector<bool> used = used_materials(scene);
    const std::vector<bool> colored = materials_shown(scene, [](const Mesh& mesh) { return !mesh.colors.empty(); });
    const uint common = needs_of_lights(scene, used, colored);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const uint needs = common | needs_of(scene.materials[i]) | uint{colored[i]} << PT_HAS_COLORS;
        kinds.of.push_back(used[i] ? index_of(kinds.needs, needs) : 0);
    }
    while (kinds.needs.size() > most_material_kinds) {
        const auto [remaining, removed] = closest(kinds.needs);
        merge(kinds, remaining, removed);
    }
    if (kinds.needs.empty()) kinds.needs.push_back(0);
    return kinds;
}

std::string name_of_needs(uint needs) {
    const std::pair<uint, const char*> names[] = {{PT_HAS_ALPHA, "alpha"},   {PT_HAS_TEXTURES, "textures"},
                                                  {PT_HAS_GLASS, "glass"},   {PT_HAS_SPECULAR, "specular"},
                                                  {PT_HAS_COAT, "coat"},     {PT_HAS_SHEEN, "sheen"},
                                                  {PT_HAS_VOLUME, "volume"}, {PT_HAS_ANISOTROPY, "anisotropy"},
                                                  {PT_HAS_COLORS, "colors"}, {PT_HAS_SECOND_UVS, "second uvs"}};
    std::string result;
    for (const auto& [id, name] : names)
        if (needs >> id & 1) result += (result.empty() ? "" : ", ") + std::string(name);
    return result.empty() ? "plain" : result;
}

}  // namespace twinray::path_tracer
