// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>

#include "cli/kernels/kernel_list.h"
#include "report/frame/cases.h"
#include "engine/accel/features_of.h"
#include "engine/core/error.h"
#include "renderer/shared.h"

namespace twinray::kernels {
namespace {

using namespace path_tracer;

using Words = std::vector<std::string>;

struct Bit {
    uint bit;
    const char* word;
};

void add_features(Words& words, uint features) {
    constexpr Bit bits[] = {
        {FEATURE_COMPRESSED, "compressed4"},
        {FEATURE_COMPRESSED8, "compressed8"},
        {FEATURE_BVH2, "bvh2"},
        {FEATURE_INSTANCES, "instances"},
        {FEATURE_MASKS, "masks"},
        {FEATURE_CULLING, "culling"},
        {FEATURE_TRANSFORMS, "transforms"},
        {FEATURE_BOXES, "boxes"},
        {FEATURE_FILTERS, "filters"},
        {FEATURE_REMAP, "reordered"},
        {FEATURE_HITS, "hits"},
    };
    if (features == FEATURES_ALL) return void(words.emplace_back("everything"));
    if (features == (FEATURES_ALL & ~FEATURE_BOXES)) return void(words.emplace_back("everything but boxes"));
    for (const Bit& bit : bits)
        if (features & bit.bit) words.emplace_back(bit.word);
}

bool asks_rays(const KernelDesc& desc) {
    return std::ranges::find(desc.constants, FEATURES_CONSTANT, &SpecializationConstant::id) != desc.constants.end();
}

void add_of_rays(Words& words, const SpecializationConstant& constant) {
    if (constant.id == FEATURES_CONSTANT) add_features(words, constant.value);
    if (constant.id == LEVEL_CONSTANT) words.emplace_back(name_of(static_cast<Level>(constant.value)));
}

void add_of_path_tracer(Words& words, const KernelDesc& desc) {
    constexpr Bit bits[] = {
        {PT_HAS_ALPHA, "alpha"},
        {PT_HAS_TEXTURES, "textures"},
        {PT_HAS_GLASS, "glass"},
        {PT_HAS_SPECULAR, "specular"},
        {PT_HAS_COAT, "coat"},
        {PT_HAS_SHEEN, "sheen"},
        {PT_HAS_ANISOTROPY, "anisotropy"},
        {PT_HAS_VOLUME, "volume"},
        {PT_HAS_MEDIA, "media"},
        {PT_HAS_COLORS, "colors"},
        {PT_HAS_SECOND_UVS, "second-uvs"},
        {PT_HAS_PANES, "panes"},
        {PT_HAS_LOCAL_LIGHTS, "lights"},
        {PT_HAS_LIGHT_TREE, "light-tree"},
        {PT_HAS_ENVIRONMENT, "environment"},
    };
    uint chosen = 0;
    for (const SpecializationConstant& constant : desc.constants)
        if (constant.value == 1 && constant.id < 32) chosen |= 1u << constant.id;
    const bool is_all = std::ranges::all_of(bits, [&](const Bit& bit) { return chosen >> bit.bit & 1; });
    if (is_all) words.emplace_back("everything");
    for (const Bit& bit : bits)
        if (!is_all && chosen >> bit.bit & 1) words.emplace_back(bit.word);
    if (std::ranges::any_of(desc.constants, [](const SpecializationConstant& constant) {
            return constant.id == TEXEL_FORMATS_CONSTANT && constant.value == 1;
        }))
        words.emplace_back("deep-textures");
    if (chosen >> PT_HAS_AOVS & 1) words.emplace_back("aovs");
    if (chosen >> PT_HAS_QUEUES & 1) words.emplace_back("queues");
}

// A constant that chooses among words, of the kernels whose names begin so.
struct Choice {
    std::string_view kernels;
    uint id;
    const char* words[2];
};

void add_of_stage(Words& words, std::string_view kernel, const SpecializationConstant& constant) {
    constexpr Choice choices[] = {{"swtlas_hierarchy", 0, {"fast", "high"}},
                                  {"swtlas_collapse", 0, {"roots", "level"}},
                                  {"sort_scatter", 3, {"values", "places"}}};
    if (kernel.starts_with("swtlas_") && constant.id == NODE_WIDTH_CONSTANT && constant.value == 8)
        words.emplace_back(name_of(Layout::compressed8));
    for (const Choice& choice : choices)
        if (kernel == choice.kernels && constant.id == choice.id && constant.value < 2)
            words.emplace_back(choice.words[constant.value]);
}

}  // namespace

std::string variant_of(const KernelDesc& desc) {
    Words words;
    if (desc.name.starts_with("path_tracer_")) {
        add_of_path_tracer(words, desc);
        return joined(words, " ");
    }
    const bool has_rays = asks_rays(desc);
    for (const SpecializationConstant& constant : desc.constants) {
        if (has_rays)
            add_of_rays(words, constant);
        else
            add_of_stage(words, desc.name, constant);
    }
    return joined(words, " ");
}

}  // namespace twinray::kernels
