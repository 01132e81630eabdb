// SPDX-License-Identifier: MIT
// What builds record, and what they move: rows of `twinray kernels`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/core/context.h"

namespace twinray::kernels {

struct BuildRow {
    std::string what;  // "build", "refit"
    std::string layout, quality;
    std::uint64_t dispatches = 0, barriers = 0, copies = 0;
    double read = 0, written = 0;  // bytes a triangle, by cli/kernels/traffic.h
};

// Of one mesh of build_triangles and one instance, by the software accelerator, in each layout and quality. The context
// runs nothing (ContextDesc::watch_kernels).
inline constexpr std::size_t build_triangles = 81'920;
std::vector<BuildRow> list_builds(Context& context);

std::string table_of(std::span<const BuildRow> rows);
nlohmann::json to_json(const BuildRow& row, const std::string& device);

}  // namespace twinray::kernels
