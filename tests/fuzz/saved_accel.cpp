// SPDX-License-Identifier: MIT
#include <cstring>

#include "engine/scene/bytes.h"
#include "swtlas/saved.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {
namespace {

std::uint64_t array_bytes(const SavedEntry& entry) {
    return entry.name_bytes + entry.positions * sizeof(vec3) + entry.triangles * sizeof(uvec3) +
           entry.boxes * sizeof(Bounds) + entry.nodes * sizeof(BvhNode) + entry.leaves * sizeof(BvhTriangle) +
           entry.records * sizeof(CompressedRecord) + entry.instances * sizeof(InstanceRecord);
}

// With every checksum, and the file's length, as they should be: a fuzzer does not guess them.
void put_checksums(std::span<std::byte> file) {
    if (file.size() < sizeof(SavedHeader)) return;
    SavedHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    const std::span<std::byte> after = file.subspan(sizeof header);
    const std::size_t count = std::min<std::uint64_t>(header.geometry_count, after.size() / sizeof(SavedEntry));
    const std::span<std::byte> entries = after.first(count * sizeof(SavedEntry));
    std::span<std::byte> arrays = after.subspan(entries.size());
    for (std::size_t i = 0; i < count; ++i) {
        SavedEntry entry;
        std::memcpy(&entry, entries.data() + i * sizeof entry, sizeof entry);
        const std::span<std::byte> own = arrays.first(std::min<std::uint64_t>(array_bytes(entry), arrays.size()));
        entry.checksum = crc32_of(own);
        arrays = arrays.subspan(own.size());
        std::memcpy(entries.data() + i * sizeof entry, &entry, sizeof entry);
    }
    header.entries_checksum = crc32_of(entries);
    header.file_bytes = file.size();
    header.checksum = crc32_of(std::as_bytes(std::span(&header, 1)).first(offsetof(SavedHeader, checksum)));
    std::memcpy(file.data(), &header, sizeof header);
}

}  // namespace

// As it is, and as someone would have made it on purpose.
void saved_accel(Input input) {
    is_taken([&] { decode_save(input, "input"); });
    Bytes file(input.begin(), input.end());
    put_checksums(std::as_writable_bytes(std::span(file)));
    is_taken([&] {
        const DecodedSave saved = decode_save(file, "input");
        const EncodedSave again = encode_save(saved.layout, saved.geometries);
        std::size_t size = again.head.size();
        for (const std::span<const std::byte> part : again.body) size += part.size();
        require(size == file.size() && std::memcmp(again.head.data(), file.data(), again.head.size()) == 0,
                "what was taken is saved as the same file");
    });
}

}  // namespace twinray::fuzz
