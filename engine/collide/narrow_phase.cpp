#include <twinray/queries.h>

#include <algorithm>
#include <numeric>

#include "engine/collide/pair_classifier.h"
#include "engine/collide/triangle_set.h"
#include "engine/core/kernel.h"
#include "engine/core/stopwatch.h"

namespace twinray {

std::size_t Contacts::count(PairClass pair_class) const {
    return static_cast<std::size_t>(std::count_if(
        list.begin(), list.end(), [&](const TriangleContact& contact) { return contact.pair_class == pair_class; }));
}

struct NarrowPhase::State {
    explicit State(Context& device)
        : context(with_float64(device, "collide: classes of triangles")),
          triangles(device),
          tree(device),
          search(device),
          classifier(device) {}

    Contacts find(const PlacedMeshes& placed, const ContactOptions& options);
    std::vector<uint> taking_part(const PlacedMeshes& placed, bool self);
    DevicePairs candidates(bool self);
    void list(Contacts& contacts, std::span<const ClassifiedPair> pairs, bool with_segments) const;

    Context& context;
    TriangleSet triangles;
    BoxTree tree;
    PairSearch search;
    PairClassifier classifier;
};

NarrowPhase::NarrowPhase(Context& context) : state_(std::make_unique<State>(context)) {}
NarrowPhase::~NarrowPhase() = default;

std::vector<PairClass> NarrowPhase::classify(std::span<const TrianglePair> pairs) {
    return state_->classifier.classify(pairs);
}

std::uint64_t NarrowPhase::max_pairs() const { return state_->search.max_pairs(); }
void NarrowPhase::set_max_pairs(std::uint64_t count) { state_->search.set_max_pairs(count); }

Contacts NarrowPhase::find(const Scene& scene, const ContactOptions& options) { return state_->find(scene, options); }
Contacts NarrowPhase::find(AbstractAccel& accel, const ContactOptions& options) {
    return state_->find(PlacedMeshes(accel), options);
}
Contacts NarrowPhase::find(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                           const ContactOptions& options) {
    return state_->find({meshes, instances}, options);
}

Contacts NarrowPhase::State::find(const PlacedMeshes& placed, const ContactOptions& options) {
    check_instances(placed.meshes, placed.instances, "collide");
    Contacts contacts;
    const Stopwatch search_start;
    const std::vector<uint> chosen = taking_part(placed, options.self);
    triangles.set(placed, chosen, options.shared);
    const DevicePairs pairs = candidates(options.self);
    contacts.instances = chosen.size();
    contacts.triangles = triangles.count();
    contacts.candidates = pairs.count;
    contacts.search_seconds = search_start.seconds();

    const Stopwatch classify_start;
    const std::vector<ClassifiedPair> classified = classifier.classify(
        pairs, {triangles.triangles_on_device(), triangles.names_on_device(),
                [&](uint item) { return triangles.triangle(item); }, [&](uint item) { return triangles.name(item); }});
    list(contacts, classified, options.segments);
    contacts.host_decided = classifier.host_count();
    contacts.host_seconds = classifier.host_seconds();
    contacts.classify_seconds = classify_start.seconds();
    return contacts;
}

// Returns the instances whose boxes overlap that of another: triangles of others have nothing to touch.
std::vector<uint> NarrowPhase::State::taking_part(const PlacedMeshes& placed, bool self) {
    std::vector<uint> chosen(placed.instances.size());
    std::iota(chosen.begin(), chosen.end(), 0u);
    if (self || chosen.empty()) return chosen;
    std::vector<Bounds> bounds;
    for (const MeshView& mesh : placed.meshes) bounds.push_back(bounds_of(mesh));
    std::vector<TreeBox> boxes;
    for (const auto& [mesh, transform] : placed.instances)
        boxes.push_back(box_of_instance(bounds[mesh], transform, static_cast<uint>(boxes.size())));
    tree.prepare(boxes.size());
    Commands commands(context, "collide instances");
    {
        const auto pass = commands.pass("collide instance boxes");
        commands.upload(tree.boxes(), std::span<const TreeBox>(boxes));
    }
    tree.record(commands);
    commands.submit();
    const DevicePairs pairs = search.find({.tree = tree.view()}, "contacts");
    std::vector<bool> takes_part(chosen.size(), false);
    for (const auto column : {&DevicePairs::first, &DevicePairs::second})
        for (const uint i : download(context, pairs, column)) takes_part[i] = true;
    std::erase_if(chosen, [&](uint i) { return !takes_part[i]; });
    return chosen;
}

DevicePairs NarrowPhase::State::candidates(bool self) {
    if (triangles.count() == 0) return {};
    triangles.build(tree);
    return search.find({.tree = tree.view(), .other_groups = !self}, "contacts");
}

void NarrowPhase::State::list(Contacts& contacts, std::span<const ClassifiedPair> pairs, bool with_segments) const {
    std::vector<std::pair<TriangleContact, std::size_t>> sorted;
    for (const ClassifiedPair& pair : pairs)
        sorted.push_back({{triangles.instance(pair.first), triangles.instance(pair.second),
                           triangles.primitive(pair.first), triangles.primitive(pair.second), pair.pair_class},
                          sorted.size()});
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [contact, index] : sorted) {
        contacts.list.push_back(contact);
        if (!with_segments) continue;
        const ClassifiedPair& pair = pairs[index];
        contacts.segments.push_back(
            pair.pair_class == PairClass::crossing
                ? crossing_segment(triangles.triangle(pair.first), triangles.triangle(pair.second))
                : ContactSegment{dvec3(0), dvec3(0)});
    }
}

}  // namespace twinray
