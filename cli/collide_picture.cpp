// SPDX-License-Identifier: MIT
#include "cli/collide_picture.h"

#include <algorithm>

namespace twinray::cli {
namespace {

// By class, from the most harmless to the worst, which is also their order.
constexpr std::array<Rgb, all_pair_classes.size()> class_colors = {plain_color,         categorical::sky_blue,
                                                                   categorical::green,  categorical::yellow,
                                                                   categorical::purple, categorical::vermilion};

Rgb color_of(PairClass pair_class) { return class_colors[static_cast<std::size_t>(pair_class)]; }

}  // namespace

ScenePicture picture_of_contacts(const Scene& scene, const Contacts& contacts) {
    const std::vector<std::size_t> first = first_faces(scene);
    std::vector<PairClass> worst(count_triangles(scene), PairClass::separate);
    for (const TriangleContact& contact : contacts.list)
        for (const std::size_t face :
             {first[contact.instance_a] + contact.triangle_a, first[contact.instance_b] + contact.triangle_b})
            worst[face] = std::max(worst[face], contact.pair_class);
    ScenePicture picture;
    std::ranges::transform(worst, std::back_inserter(picture.colors), color_of);
    for (std::size_t i = 0; i < contacts.segments.size(); ++i)
        if (contacts.list[i].pair_class == PairClass::crossing)
            picture.strokes.push_back({.from = contacts.segments[i].from, .to = contacts.segments[i].to});
    picture.page.legend.title = "worst contact";
    for (std::size_t i = all_pair_classes.size(); i-- > 0;) {
        const PairClass each = all_pair_classes[i];
        const bool is_none = each == PairClass::separate;
        picture.page.legend.entries.push_back({color_of(each), is_none ? "none" : std::string(name_of(each))});
    }
    if (!picture.strokes.empty()) picture.page.legend.entries.push_back({ink, "intersection"});
    return picture;
}

ScenePicture picture_of_pairs(const PictureOptions& options, const Scene& scene,
                              const std::vector<InstancePair>& pairs) {
    std::vector<double> overlaps(scene.instances.size());
    for (const InstancePair& pair : pairs) ++overlaps[pair.a], ++overlaps[pair.b];
    std::vector<double> values;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        values.insert(values.end(), scene.meshes[scene.instances[i].mesh].triangles.size(), overlaps[i]);
    return picture_of_values(options, values, "overlaps");
}

}  // namespace twinray::cli
