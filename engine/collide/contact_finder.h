// SPDX-License-Identifier: MIT
#pragma once

#include <compare>

#include <twinray/scene.h>

#include "engine/collide/pair_classifier.h"
#include "engine/collide/triangle_set.h"

namespace twinray {

// Two triangles that have a point in common: instance_a < instance_b, or in one instance, triangle_a < triangle_b.
struct TriangleContact {
    uint instance_a = 0, instance_b = 0;
    uint triangle_a = 0, triangle_b = 0;
    PairClass pair_class = PairClass::separate;

    auto operator<=>(const TriangleContact&) const = default;
};

struct ContactOptions {
    // Also pairs within an instance, but for those that have no more in common than vertices that they share and the
    // edge between two of them. Pairs of its neighbours that are folded onto each other overlap.
    bool self = false;
    Shared shared = Shared::by_index;
    bool segments = false;  // of pairs of class crossing
};

struct Contacts {
    std::vector<TriangleContact> list;     // ascending
    std::vector<ContactSegment> segments;  // by contact, of class crossing, others (0, 0, 0); empty unless asked for
    std::uint64_t instances = 0;           // whose boxes overlap others, or all where pairs within them count
    std::uint64_t triangles = 0;           // of them
    std::uint64_t candidates = 0;          // pairs of triangles whose boxes overlap
    std::uint64_t host_decided = 0;        // of those, undecided by float64
    double search_seconds = 0, classify_seconds = 0, host_seconds = 0;  // the last is part of the one before

    std::size_t count(PairClass pair_class) const;
};

// Finds all pairs of triangles of different instances that touch or intersect, and how: exactly, for corners in world
// space as shaders/shared/world_corner.h defines them. Triangles with a corner that is not finite take no part.
class ContactFinder {
  public:
    // Throws Error where the device has no float64.
    explicit ContactFinder(Context& context);

    // Submits and waits. Throws Error naming what is wrong with a mesh or an instance, or the number of pairs of boxes
    // that overlap where that exceeds max_pairs().
    Contacts find(const Scene& scene, const ContactOptions& options = {});
    Contacts find(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                  const ContactOptions& options = {});
    // The class of each pair of triangles given: see PairClassifier.
    std::vector<PairClass> classify(std::span<const TrianglePair> pairs) { return classifier_.classify(pairs); }

    // Of boxes, of instances and of triangles. Default: 2^27. See PairSearch.
    std::uint64_t max_pairs() const { return search_.max_pairs(); }
    void set_max_pairs(std::uint64_t count) { search_.set_max_pairs(count); }

  private:
    std::vector<uint> taking_part(std::span<const MeshView> meshes, std::span<const MeshInstance> instances, bool self);
    DevicePairs candidates(bool self);
    void list(Contacts& contacts, std::span<const ClassifiedPair> pairs, bool with_segments) const;

    Context& context_;
    TriangleSet triangles_;
    BoxTree tree_;
    PairSearch search_;
    PairClassifier classifier_;
};

}  // namespace twinray
