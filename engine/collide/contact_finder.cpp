// SPDX-License-Identifier: MIT
#include "engine/collide/contact_finder.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace twinray {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

std::size_t Contacts::count(PairClass pair_class) const {
    return static_cast<std::size_t>(std::count_if(
        list.begin(), list.end(), [&](const TriangleContact& contact) { return contact.pair_class == pair_class; }));
}

ContactFinder::ContactFinder(Context& context)
    : context_(context), triangles_(context), tree_(context), search_(context), classifier_(context) {}

Contacts ContactFinder::find(const Scene& scene, const ContactOptions& options) {
    const std::vector<MeshView> meshes(scene.meshes.begin(), scene.meshes.end());
    std::vector<MeshInstance> instances;
    for (const Instance& instance : scene.instances) instances.push_back({instance.mesh, instance.transform});
    return find(meshes, instances, options);
}

Contacts ContactFinder::find(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                             const ContactOptions& options) {
    check_placed(meshes, instances, "collide");
    Contacts contacts;
    const Clock::time_point search_start = Clock::now();
    const std::vector<uint> chosen = taking_part(meshes, instances, options.self);
    triangles_.set(meshes, instances, chosen, options.shared);
    const DevicePairs pairs = candidates(options.self);
    contacts.instances = chosen.size();
    contacts.triangles = triangles_.count();
    contacts.candidates = pairs.count;
    contacts.search_seconds = seconds_since(search_start);

    const Clock::time_point classify_start = Clock::now();
    const std::vector<ClassifiedPair> classified =
        classifier_.classify(pairs, {triangles_.corners_on_device(), triangles_.names_on_device(),
                                     [this](uint item) { return triangles_.corners(item); },
                                     [this](uint item) { return triangles_.name(item); }});
    list(contacts, classified, options.segments);
    contacts.host_decided = classifier_.host_count();
    contacts.host_seconds = classifier_.host_seconds();
    contacts.classify_seconds = seconds_since(classify_start);
    return contacts;
}

// Those whose boxes overlap that of another: the triangles of others have nothing to touch.
std::vector<uint> ContactFinder::taking_part(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                                             bool self) {
    std::vector<uint> chosen(instances.size());
    std::iota(chosen.begin(), chosen.end(), 0u);
    if (self || instances.empty()) return chosen;
    std::vector<Bounds> bounds;
    for (const MeshView& mesh : meshes) bounds.push_back(bounds_of(mesh));
    std::vector<TreeBox> boxes;
    for (const uint i : chosen) boxes.push_back(box_of_instance(bounds[instances[i].mesh], instances[i].transform, i));
    tree_.prepare(boxes.size());
    Commands commands(context_, "collide instances");
    {
        const auto pass = commands.pass("collide instance boxes");
        commands.upload(tree_.boxes(), std::span<const TreeBox>(boxes));
    }
    tree_.record(commands);
    commands.submit();
    const DevicePairs pairs = search_.find({.tree = tree_.view()}, "contacts");
    std::vector<bool> takes_part(instances.size(), false);
    for (const auto column : {&DevicePairs::first, &DevicePairs::second})
        for (const uint i : download(context_, pairs, column)) takes_part[i] = true;
    std::erase_if(chosen, [&](uint i) { return !takes_part[i]; });
    return chosen;
}

DevicePairs ContactFinder::candidates(bool self) {
    if (triangles_.count() == 0) return {};
    Commands commands(context_, "collide triangles");
    triangles_.record(commands, tree_.prepare(triangles_.count()));
    tree_.record(commands);
    commands.submit();
    return search_.find({.tree = tree_.view(), .other_groups = !self}, "contacts");
}

void ContactFinder::list(Contacts& contacts, std::span<const ClassifiedPair> pairs, bool with_segments) const {
    std::vector<std::pair<TriangleContact, std::size_t>> sorted;
    for (const ClassifiedPair& pair : pairs)
        sorted.push_back({{triangles_.instance(pair.first), triangles_.instance(pair.second),
                           triangles_.primitive(pair.first), triangles_.primitive(pair.second), pair.pair_class},
                          sorted.size()});
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [contact, index] : sorted) {
        contacts.list.push_back(contact);
        if (!with_segments) continue;
        const ClassifiedPair& pair = pairs[index];
        contacts.segments.push_back(
            pair.pair_class == PairClass::crossing
                ? crossing_segment(triangles_.corners(pair.first), triangles_.corners(pair.second))
                : ContactSegment{dvec3(0), dvec3(0)});
    }
}

}  // namespace twinray
