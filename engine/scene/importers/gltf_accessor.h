// SPDX-License-Identifier: MIT
// Reading accessors, with every byte range, type and sparse index checked before memory is touched.
#pragma once

#include "twinray/glsl/cpp.h"
#include "engine/scene/importers/gltf_file.h"

namespace twinray {

// Reads all elements as floats, `components` per element. Normalised integers become [-1, 1] or [0, 1], others keep
// their value (KHR_mesh_quantization). 16 components are a matrix, column by column. `object` names the reader in
// errors: "mesh 2 'wheel' primitive 0 POSITION".
std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& object);

// The same as vectors of N floats.
template <int N>
std::vector<Vec<N, float>> read_vectors(const GltfFile& file, int accessor, const std::string& object) {
    const std::vector<float> floats = read_floats(file, accessor, N, object);
    std::vector<Vec<N, float>> vectors(floats.size() / N);
    for (std::size_t i = 0; i < floats.size(); ++i) vectors[i / N][static_cast<int>(i % N)] = floats[i];
    return vectors;
}

// Reads unsigned scalars of 8, 16 or 32 bits.
std::vector<uint> read_indices(const GltfFile& file, int accessor, const std::string& object);

}  // namespace twinray
