// SPDX-License-Identifier: MIT
#include <cstring>

#include "engine/scene/bytes.h"
#include "tests/fuzz/contract.h"
#include <twinray/analysis.h>

namespace twinray::fuzz {
namespace {

constexpr std::string_view first_lines = "twinray view-factor rows 2\nof a fuzzer\n";

// A row as files have it: 72 bytes, of which the second four say how many factors of 20 bytes follow, and a checksum.
constexpr std::size_t head_bytes = 72;

// With the rows' checksums as they should be: a fuzzer does not guess them.
void put_checksums(std::span<std::uint8_t> rows) {
    while (rows.size() >= head_bytes) {
        std::uint32_t factors = 0;
        std::memcpy(&factors, rows.data() + sizeof factors, sizeof factors);
        const std::uint64_t size = head_bytes + std::uint64_t{factors} * sizeof(ViewFactor);
        if (size + sizeof(std::uint32_t) > rows.size()) return;
        const std::uint32_t sum = crc32_of(std::as_bytes(rows.first(size)));
        std::memcpy(rows.data() + size, &sum, sizeof sum);
        rows = rows.subspan(size + sizeof sum);
    }
}

void load_rows(Input bytes) {
    const std::filesystem::path file = file_of(bytes, "input.rows");
    is_taken([&] {
        const std::vector<ViewFactorRow> rows = RowFile(file, "of a fuzzer").load();
        for (std::size_t i = 0; i < rows.size(); ++i) require(rows[i].group == i, "rows come in order, without a gap");
        require(RowFile(file, "of a fuzzer").load().size() == rows.size(), "a second run finds what the first found");
    });
}

}  // namespace

void rows(Input input) {
    load_rows(input);
    Bytes file(first_lines.begin(), first_lines.end());
    file.insert(file.end(), input.begin(), input.end());
    put_checksums(std::span(file).subspan(first_lines.size()));
    load_rows(file);
}

}  // namespace twinray::fuzz
