// SPDX-License-Identifier: MIT
// What the engine built, read from its memory and compared with trees of ours.
#pragma once

#include <twinray/tlas.h>

#include "tree.h"

// Throws Error naming the first node that differs.
void check_binary(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes, int root);
// How many records, nodes and triangles, were compared.
std::size_t check_wide(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes);
