// SPDX-License-Identifier: MIT
// The slots of a tree, distributed among the blocks of its leaves.
#ifndef TWINRAY_SWTLAS_SLOTS_GLSL
#define TWINRAY_SWTLAS_SLOTS_GLSL
#include "shaders/shared/compressed.h"

layout(constant_id = NODE_WIDTH_CONSTANT) const uint NODE_WIDTH = 4u;

uint slots_begin(BuildTree tree, LeafChunk chunk) { return record_count(chunk.first - tree.first, NODE_WIDTH); }
uint slots_end(BuildTree tree, LeafChunk chunk)
{
    return record_count(chunk.first - tree.first + chunk.count, NODE_WIDTH);
}
#endif
