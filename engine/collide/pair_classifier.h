// Classifies pairs of triangles by how they touch: on the device and, if that is uncertain, exactly on the host.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/collide/exact_class.h"
#include "engine/collide/box_tree.h"

namespace twinray {

// Two items and their class, which is not separate.
struct ClassifiedPair {
    uint first = 0;
    uint second = 0;
    PairClass pair_class = PairClass::separate;
};

// Classifies pairs of triangles: the GPU decides if float64 is certain, else the host, without error.
class PairClassifier {
  public:
    // Throws Error if the device has no float64.
    explicit PairClassifier(Context& context);

    // The triangles of items: on the device, and the same on the host.
    struct Items {
        Ref<WorldTriangle> triangles;
        Ref<TriangleName> names;
        std::function<WorldTriangle(uint)> host_triangle;
        std::function<TriangleName(uint)> host_name;
    };
    // Returns the pairs that are not separate, in no order. Submits and waits.
    std::vector<ClassifiedPair> classify(const DevicePairs& pairs, const Items& items);
    // Classifies each pair. Throws Error for a vertex that is not finite or out of the range of exact_class().
    std::vector<PairClass> classify(std::span<const TrianglePair> pairs);

    // Return the number of pairs that the host decided in the last call, and the time that it took.
    std::uint64_t host_count() const { return host_count_; }
    double host_seconds() const { return host_seconds_; }

  private:
    std::uint64_t run(const DevicePairs& pairs, std::uint64_t begin, uint count, const Items& items);
    void decide(std::vector<PairContact>& contacts, const Items& items);

    Context& context_;
    Kernel<ClassifyArgs> kernel_;
    Buffer contacts_, total_;
    Pace pace_;
    std::uint64_t host_count_ = 0;
    double host_seconds_ = 0;
};

}  // namespace twinray
