// SPDX-License-Identifier: MIT
#include "engine/scene/importers/weld.h"

#include <array>
#include <bit>
#include <unordered_map>

#include "engine/core/error.h"
#include "engine/core/fnv1a.h"

namespace twinray {
namespace {

// Position, normal, tangent, both uvs and color; missing ones stay 0.
using Key = std::array<float, 18>;

struct HashBits {
    std::size_t operator()(const Key& key) const {
        Fnv1a hash;  // over words, with a final mix for the low bits
        for (const float value : key) hash.add(std::bit_cast<std::uint32_t>(value));
        return hash.value() ^ hash.value() >> 29;
    }
};

struct EqualBits {
    bool operator()(const Key& a, const Key& b) const {
        for (std::size_t i = 0; i < a.size(); ++i)  // NaN included, which == would keep apart
            if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
        return true;
    }
};

template <int N>
void put(Key& key, std::size_t first, const std::vector<Vec<N, float>>& values, std::size_t vertex) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < N; ++i) key[first + i] = values[vertex][i] + 0.0f;  // -0 -> 0
}

template <class Vector>
void copy(std::vector<Vector>& target, const std::vector<Vector>& source, std::size_t vertex) {
    if (!source.empty()) target.push_back(source[vertex]);
}

}  // namespace

Mesh weld_equal_vertices(const Mesh& mesh) {
    Mesh welded;
    welded.name = mesh.name;
    welded.materials = mesh.materials;
    std::unordered_map<Key, uint, HashBits, EqualBits> firsts(mesh.positions.size());
    std::vector<uint> moved_to(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Key key{};
        put(key, 0, mesh.positions, i);
        put(key, 3, mesh.normals, i);
        put(key, 6, mesh.tangents, i);
        put(key, 10, mesh.uvs, i);
        put(key, 12, mesh.second_uvs, i);
        put(key, 14, mesh.colors, i);
        const auto [entry, is_new] = firsts.try_emplace(key, static_cast<uint>(welded.positions.size()));
        moved_to[i] = entry->second;
        if (!is_new) continue;
        copy(welded.positions, mesh.positions, i);
        copy(welded.normals, mesh.normals, i);
        copy(welded.tangents, mesh.tangents, i);
        copy(welded.uvs, mesh.uvs, i);
        copy(welded.second_uvs, mesh.second_uvs, i);
        copy(welded.colors, mesh.colors, i);
    }
    for (const uvec3& t : mesh.triangles) welded.triangles.emplace_back(moved_to[t.x], moved_to[t.y], moved_to[t.z]);
    return welded;
}

Mesh weld_unindexed(Mesh mesh) {
    if (mesh.positions.size() > UINT32_MAX) fail("mesh '", mesh.name, "': has over 2^32 vertices");
    const uint count = static_cast<uint>(mesh.positions.size() / 3);
    mesh.triangles.clear();
    for (uint i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    return weld_equal_vertices(mesh);
}

}  // namespace twinray
