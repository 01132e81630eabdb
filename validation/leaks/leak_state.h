// SPDX-License-Identifier: MIT
// The findings of a leak test, as a file from which a later run goes on.
#pragma once

#include <twinray/validation.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace twinray {

struct LeakState {
    LeakCounts counts;
    double seconds = 0;  // spent on tracing
};

// Traces until `rays` are traced in all; after(count) is called when a batch of so many rays is done.
void trace_until(const LeakTest& test, std::uint64_t rays, LeakState& state,
                 const std::function<void(const LeakFault&)>& on_fault, const std::function<void(std::size_t)>& after);

// Returns FNV-1a (Fowler, Noll, Vo) of all vertices, by which a state knows its mesh.
std::uint64_t hash_of(const Mesh& mesh);

// `identity`: what a run must have in common with the one that it continues. Throws Error naming the file if that
// differs, or if the file holds no state.
LeakState read_state(const std::filesystem::path& file, const nlohmann::json& identity);
// Writes the whole file or nothing: whenever the process ends, it is that of some earlier call. Throws Error naming it.
void write_state(const std::filesystem::path& file, nlohmann::json identity, const LeakState& state);

}  // namespace twinray
