// SPDX-License-Identifier: MIT
#include "bench/hits_hash.h"

#include <bit>

namespace twinray::bench {
namespace {

class Fnv1a {
  public:
    void add(std::uint32_t word) {
        for (int byte = 0; byte < 4; ++byte, word >>= 8) state_ = (state_ ^ (word & 0xff)) * 0x100000001b3u;
    }
    void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
    std::uint64_t state() const { return state_; }

  private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace

std::uint64_t hash_of(std::span<const Hit> hits, Query query) {
    Fnv1a hash;
    for (const Hit& hit : hits) {
        hash.add(hit.hit);
        if (query == Query::any) continue;
        hash.add(hit.primitive_index);
        hash.add(hit.instance_index);
        for (const float value : {hit.t, hit.u, hit.v}) hash.add(value);
    }
    return hash.state();
}

std::string hexadecimal(std::uint64_t hash) {
    std::string digits(16, '0');
    for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
    return digits;
}

}  // namespace twinray::bench
