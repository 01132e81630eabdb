// SPDX-License-Identifier: MIT
#include "report/reproducer/ddmin.h"

#include <algorithm>
#include <numeric>

namespace twinray::reproducer {
namespace {

// The first index of part `part` of `parts` nearly equal ones.
std::ptrdiff_t begin_of(std::size_t part, std::size_t parts, std::size_t count) {
    return static_cast<std::ptrdiff_t>(part * count / parts);
}

Indices part_of(const Indices& all, std::size_t part, std::size_t parts) {
    return {all.begin() + begin_of(part, parts, all.size()), all.begin() + begin_of(part + 1, parts, all.size())};
}

Indices without(const Indices& all, std::size_t part, std::size_t parts) {
    Indices rest(all.begin(), all.begin() + begin_of(part, parts, all.size()));
    rest.insert(rest.end(), all.begin() + begin_of(part + 1, parts, all.size()), all.end());
    return rest;
}

}  // namespace

Indices ddmin(std::size_t count, const ShowsFault& shows_fault) {
    Indices kept(count);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    std::size_t parts = 2;
    // One part of `parts`, or all but one; halves are each other's rest.
    const auto reduced = [&](const auto& choose, std::size_t next_parts) {
        for (std::size_t part = 0; part < parts; ++part)
            if (Indices fewer = choose(kept, part, parts); shows_fault(fewer)) {
                kept = std::move(fewer);
                parts = next_parts;
                return true;
            }
        return false;
    };
    while (kept.size() >= 2) {
        parts = std::min(parts, kept.size());
        if (reduced(part_of, 2)) continue;
        if (parts > 2 && reduced(without, std::max<std::size_t>(parts - 1, 2))) continue;
        if (parts == kept.size()) break;
        parts = 2 * parts;
    }
    return kept;
}

}  // namespace twinray::reproducer
