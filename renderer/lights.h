// The lights of a scene, and how one is chosen.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

// A light with a position: a triangle, two that make a quadrilateral, a point, a spot.
struct PlacedLight {
    vec3 lo, hi;             // the box around it
    vec3 axis;               // unit
    float power;             // as LightNode::power; above 0
    double axes_angle = 0;   // how far from `axis` a direction still counts as its axis; in radians
    double reach_angle = 0;  // see LightNode::cos_reach
    bool is_two_sided = false;
    uint light = 0;  // its index, or that of the first triangle
    uint count = 1;
};

struct LightTree {
    std::vector<LightNode> nodes;  // the root first; empty: no lights
    std::vector<uint> ways;        // by index of a light, see chance_of_way
};

// light_count is above all indices. Splits at the least orientation-aware surface area heuristic of Conty and Kulla.
LightTree build_light_tree(std::span<const PlacedLight> lights, std::size_t light_count);

// How a light is chosen. The environment, the suns and the lights with a position have the same share each. A sun is
// chosen by its power, another light in a tree by the lit point, or, without a tree, also by its power.
enum class LightChoice { table, tree };

// The emissive triangles and punctual lights of a scene.
struct LocalLights {
    std::vector<Emitter> emitters;
    std::vector<std::vector<float>> densities;  // per instance, then triangle: see SurfaceInstance; empty if dark
    std::vector<std::vector<uint>> ways;        // likewise
    std::vector<PunctualLight> punctual;
    // Indexed by light: emitters, then punctual lights, the suns last. It has parts, each of which chooses by power:
    // one for each leaf of the tree, and one of `table_count` lights from `table_first` on, chosen with `table_chance`.
    std::vector<AliasEntry> table;
    uint table_first = 0, table_count = 0;
    float table_chance = 1;
    LightTree tree;  // empty without LightChoice::tree
    LightChoice by = LightChoice::table;
    bool has_suns = false, has_placed = false;

    bool empty() const { return emitters.empty() && punctual.empty(); }
    // Returns the number of kinds of lights that have a share beside the environment.
    uint kind_count() const { return uint{has_suns} + uint{has_placed}; }
};

// Makes columns that choose i with probability weights[i] / their sum, in constant time (Walker 1977). Weights are
// finite and >= 0; the table is empty for none or for all 0. Vose, "A linear algorithm for generating random numbers
// with a given distribution", 1991.
std::vector<AliasEntry> make_alias_table(std::span<const double> weights);

using LocalLightSet = TWINRAY_MULTI_TYPE_SET(LocalLightsView, LOCAL_LIGHTS);

// The lights in device memory. Their number may change; a light keeps its key.
class LightSet {
  public:
    explicit LightSet(Context& context) : set_(context, "local lights") {}

    // Replaces the previous lights. Returns the keys by index.
    std::vector<SetKey> put(const LocalLights& lights);
    LocalLightsView view() const { return set_.view(); }
    std::uint64_t buffer_bytes() const { return set_.buffer_bytes(); }

  private:
    LocalLightSet set_;
    std::vector<SetKey> emitters_, punctual_;  // all that there ever were at once
};

// Builds a tree if that can gain anything: if two lights or more have a position.
LocalLights collect_lights(const Scene& scene);
LocalLights collect_lights(const Scene& scene, LightChoice by);

// Returns whether the scene has light to see by: a punctual light, or a surface brighter than the radiance 1 that glTF
// allows without KHR_materials_emissive_strength, which is the glow of a label or a screen rather than a lamp.
bool has_lamps(const Scene& scene);

// Returns a sentence for each material that the scene shows and that stops the light of its punctual lights though it
// is glass: shadow rays pass only panes, and no path that is bent or blurred finds a light without size.
std::vector<std::string> stopped_lights(const Scene& scene);

}  // namespace twinray::path_tracer
