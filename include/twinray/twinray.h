// SPDX-License-Identifier: MIT
// All of twinray but vma_adapter.h, which needs the application's Vulkan Memory Allocator.
#pragma once

#include <twinray/abstract_accel.h>
#include <twinray/commands.h>
#include <twinray/context.h>
#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include <twinray/trace.h>
#include <twinray/validation.h>
#include <twinray/world.h>
