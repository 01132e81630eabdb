// SPDX-License-Identifier: MIT
// The slots of a tree, shared out among the blocks of its leaves.
#ifndef TWINRAY_SWTLAS_SLOTS_GLSL
#define TWINRAY_SWTLAS_SLOTS_GLSL
#include "shaders/shared/compressed.h"

uint slots_begin(BuildTree tree, BuildBlock block) { return record_count(block.first - tree.first); }
uint slots_end(BuildTree tree, BuildBlock block) { return record_count(block.first - tree.first + block.count); }
#endif
