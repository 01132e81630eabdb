// SPDX-License-Identifier: MIT
#include "bench/hits_hash.h"

#include "engine/core/fnv1a.h"

namespace twinray::bench {
std::uint64_t hash_of(std::span<const Hit> hits, Query query) {
    Fnv1a hash;
    for (const Hit& hit : hits) {
        hash.add_bytes(std::span(&hit.hit, 1));
        if (query == Query::any) continue;
        for (const uint index : {hit.primitive_index, hit.instance_index}) hash.add_bytes(std::span(&index, 1));
        for (const float value : {hit.t, hit.u, hit.v}) hash.add_bytes(std::span(&value, 1));
    }
    return hash.value();
}

}  // namespace twinray::bench
