// SPDX-License-Identifier: MIT
#include "swtlas/weld.h"

#include <array>
#include <bit>
#include <cstdint>

#include "swtlas/structures.h"

namespace twinray {
namespace {

using Bits = std::array<std::uint32_t, 3>;

// A hash table from positions to their numbers, with linear probing: at most half of the slots are taken.
class Numbers {
  public:
    explicit Numbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), NOTHING) {}

    uint number_of(vec3 position, std::vector<vec3>& distinct) {
        const auto bits = std::bit_cast<Bits>(position);
        for (std::size_t slot = hash(bits);; ++slot) {
            uint& number = slots_[slot & (slots_.size() - 1)];
            if (number == NOTHING) {
                number = static_cast<uint>(distinct.size());
                distinct.push_back(position);
                return number;
            }
            if (std::bit_cast<Bits>(distinct[number]) == bits) return number;
        }
    }

  private:
    // The low bits of coordinates of a grid are 0: the high bits of the products are mixed in.
    static std::size_t hash(const Bits& bits) {
        const std::uint64_t mixed =
            bits[0] * 0x9e3779b97f4a7c15u ^ bits[1] * 0xc2b2ae3d27d4eb4fu ^ bits[2] * 0x165667b19e3779f9u;
        return mixed ^ mixed >> 29;
    }

    std::vector<uint> slots_;
};

}  // namespace

Welded weld(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    std::vector<std::uint8_t> is_used(positions.size());
    for (const uvec3& t : triangles) is_used[t.x] = is_used[t.y] = is_used[t.z] = 1;
    Welded welded;
    Numbers numbers(positions.size());
    std::vector<uint> number_of(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (is_used[i]) number_of[i] = numbers.number_of(positions[i], welded.positions);
    if (welded.positions.size() > positions.size() / 16 * 15) return {};
    welded.triangles.reserve(triangles.size());
    for (const uvec3& t : triangles) welded.triangles.emplace_back(number_of[t.x], number_of[t.y], number_of[t.z]);
    return welded;
}

}  // namespace twinray
