// Files of twinray's own with checksums: as they are, and with corrected checksums, since a fuzzer does not guess them.
#include <cstring>

#include "engine/core/files.h"
#include "renderer/film_file.h"
#include "swtlas/saved.h"
#include "tests/fuzz/targets.h"
#include <twinray/analysis.h>

namespace twinray::fuzz {
namespace {

void load_film(Input bytes) {
    is_taken([&] {
        path_tracer::Film film = path_tracer::load_film(file_of(bytes, "input.film"));
        require(film.pixels.size() == std::size_t{film.width} * film.height, "a film has its pixels");
        film.mean();
        film.error();
        film.blocks.end();
        film.merge(path_tracer::Film::empty(film.width, film.height, film.block_size, film.configuration), "a", "b");
    });
}

constexpr std::string_view first_lines = "twinray view-factor rows 2\nof a fuzzer\n";

// A row in a file has 72 bytes, of which the second four say how many factors of 20 bytes follow, and a checksum.
constexpr std::size_t head_bytes = 72;

void put_row_checksums(std::span<std::uint8_t> rows) {
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

std::uint64_t array_bytes(const SavedEntry& entry) {
    return entry.name_bytes + entry.positions * sizeof(vec3) + entry.triangles * sizeof(uvec3) +
           entry.boxes * sizeof(Bounds) + entry.nodes * sizeof(BvhNode) + entry.leaves * sizeof(BvhTriangle) +
           entry.records * sizeof(CompressedRecord) + entry.instances * sizeof(InstanceRecord);
}

// Also sets the file's length, as if someone had made the file on purpose.
void put_accel_checksums(std::span<std::byte> file) {
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

// The checksum is at the end of the file.
void film(Input input) {
    load_film(input);
    Bytes file(input.begin(), input.end());
    if (file.size() < sizeof(std::uint32_t)) return;
    const std::size_t body = file.size() - sizeof(std::uint32_t);
    const std::uint32_t sum = crc32_of(std::as_bytes(std::span(file)).first(body));
    std::memcpy(file.data() + body, &sum, sizeof sum);
    load_film(file);
}

void rows(Input input) {
    load_rows(input);
    Bytes file(first_lines.begin(), first_lines.end());
    file.insert(file.end(), input.begin(), input.end());
    put_row_checksums(std::span(file).subspan(first_lines.size()));
    load_rows(file);
}

void saved_accel(Input input) {
    is_taken([&] { decode_save(input, "input"); });
    Bytes file(input.begin(), input.end());
    put_accel_checksums(std::as_writable_bytes(std::span(file)));
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
