// SPDX-License-Identifier: MIT
// The headers of accelerators, rays and verification. Scenes (scene.h), analyses (analysis.h), queries (queries.h),
// sets (sets.h) and vma_adapter.h are included by themselves.
#pragma once

#include <twinray/abstract_accel.h>
#include <twinray/commands.h>
#include <twinray/context.h>
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include <twinray/trace.h>
#include <twinray/validation.h>
#include <twinray/world.h>
