// SPDX-License-Identifier: MIT
// Reads the engine's tree from its memory and compares it with the tutorial's trees.
#pragma once

#include <twinray/tlas.h>

#include "tree.h"

// Throws Error naming the first node that differs.
void check_binary(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes, int root);
// Returns how many records, nodes and triangles, were compared.
std::size_t check_wide(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes);
