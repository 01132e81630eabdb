// SPDX-License-Identifier: MIT
#include "validation/leaks/leak_state.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/fnv1a.h"
#include "engine/core/stopwatch.h"
#include "engine/core/json_input.h"

namespace twinray {

void trace_until(const LeakTest& test, std::uint64_t rays, LeakState& state,
                 const std::function<void(const LeakFault&)>& on_fault, const std::function<void(std::size_t)>& after) {
    constexpr std::uint64_t batch_size = 1 << 17;
    const Stopwatch begin;
    const double seconds_before = state.seconds;
    while (state.counts.rays < rays) {
        const auto count = static_cast<std::size_t>(std::min(batch_size, rays - state.counts.rays));
        test.trace(count, state.counts, on_fault);
        state.seconds = seconds_before + begin.seconds();
        after(count);
    }
}

std::uint64_t hash_of(const Mesh& mesh) {
    Fnv1a hash;  // over words
    for (const uvec3& triangle : mesh.triangles)
        for (int vertex = 0; vertex < 3; ++vertex)
            for (int axis = 0; axis < 3; ++axis)
                hash.add(std::bit_cast<std::uint32_t>(mesh.positions[triangle[vertex]][axis]));
    return hash.value();
}

LeakState read_state(const std::filesystem::path& file, const nlohmann::json& identity) {
    std::ifstream in(file);
    nlohmann::json state;
    try {
        state = parse_json<nlohmann::json>(in);
    } catch (const std::exception&) {
        state = {};
    }
    if (!state.is_object()) fail("'", file.string(), "' does not hold the state of a `twinray leaks`");
    for (const auto& [name, value] : identity.items())
        if (const nlohmann::json was = state.value(name, nlohmann::json()); was != value)
            fail("'", file.string(), "' belongs to another run: its ", name, " is ", was.dump(), ", not ",
                 value.dump());
    try {
        const auto count = [&](const char* name) { return unsigned_of<std::uint64_t>(state.at(name)); };
        return {{count("rays"), count("leaks"), count("double_hits"), count("unspecified")}, state.at("seconds")};
    } catch (const std::exception& error) {
        fail("'", file.string(), "': ", error.what());
    }
}

void write_state(const std::filesystem::path& file, nlohmann::json identity, const LeakState& state) {
    identity.update({{"rays", state.counts.rays},
                     {"leaks", state.counts.leaks},
                     {"double_hits", state.counts.double_hits},
                     {"unspecified", state.counts.unspecified},
                     {"seconds", state.seconds}});
    write_file(file, identity.dump(2) + '\n');
}

}  // namespace twinray
