// SPDX-License-Identifier: MIT
#include "engine/analysis/row_file.h"

#include <cstring>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/bytes.h"

namespace twinray {
namespace {

constexpr std::string_view magic = "twinray view-factor rows 2\n";

struct RowHeader {
    uint group;
    uint factor_count;
    std::uint64_t rays;
    std::uint64_t hits;
    Estimate open, back;
};
static_assert(sizeof(RowHeader) == 72);

template <class T>
void put(std::vector<std::byte>& out, std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

std::vector<std::byte> bytes_of(const ViewFactorRow& row) {
    const RowHeader header{row.group, static_cast<uint>(row.factors.size()), row.rays, row.hits, row.open, row.back};
    std::vector<std::byte> bytes;
    put(bytes, std::span(&header, 1));
    put(bytes, std::span(row.factors));
    const uint sum = crc32_of(bytes);
    put(bytes, std::span(&sum, 1));
    return bytes;
}

class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(std::as_bytes(bytes)) {}

    std::size_t at() const { return at_; }
    void skip(std::size_t count) { at_ += count; }
    // Nothing where the next row is not whole.
    std::optional<ViewFactorRow> row() {
        RowHeader header;
        if (!peek(&header, at_, sizeof(header))) return std::nullopt;
        const std::uint64_t size = sizeof(header) + std::uint64_t{header.factor_count} * sizeof(ViewFactor);
        uint sum = 0;
        if (!peek(&sum, at_ + size, sizeof(sum)) || sum != crc32_of(bytes_.subspan(at_, size))) return std::nullopt;
        ViewFactorRow row{header.group, header.rays, std::vector<ViewFactor>(header.factor_count),
                          header.hits,  header.open, header.back};
        peek(row.factors.data(), at_ + sizeof(header), size - sizeof(header));
        at_ += size + sizeof(sum);
        return row;
    }

  private:
    bool peek(void* to, std::uint64_t from, std::uint64_t size) const {
        if (from > bytes_.size() || size > bytes_.size() - from) return false;
        if (size) std::memcpy(to, bytes_.data() + from, size);
        return true;
    }

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

}  // namespace

RowFile::RowFile(std::filesystem::path file, std::string configuration)
    : file_(std::move(file)), configuration_(text(magic, configuration, '\n')) {}

std::vector<ViewFactorRow> RowFile::load() {
    if (!std::filesystem::exists(file_)) {
        create();
        return {};
    }
    const Bytes bytes = read_file(file_);
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), configuration_.size()));
    if (head != configuration_)
        fail("'", file_.string(), "': unfinished rows of another scene or of other options; they cannot be resumed");
    Reader reader(bytes);
    reader.skip(configuration_.size());
    std::vector<ViewFactorRow> rows;
    std::size_t whole = reader.at();
    while (std::optional<ViewFactorRow> row = reader.row()) {
        if (row->group != rows.size()) break;
        rows.push_back(std::move(*row));
        whole = reader.at();
    }
    std::filesystem::resize_file(file_, whole);
    open_at(whole);
    return rows;
}

void RowFile::create() {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << configuration_;
    open_at(configuration_.size());
}

void RowFile::open_at(std::uint64_t bytes) {
    out_.open(file_, std::ios::binary | std::ios::app);
    std::error_code error;
    if (!out_ || std::filesystem::file_size(file_, error) != bytes || error)
        fail("'", file_.string(), "' cannot be written");
}

void RowFile::append(std::span<const ViewFactorRow> rows) {
    for (const ViewFactorRow& row : rows) {
        const std::vector<std::byte> bytes = bytes_of(row);
        out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    if (!out_.flush()) fail("'", file_.string(), "' cannot be written");
}

void RowFile::remove() {
    out_.close();
    std::filesystem::remove(file_);
}

}  // namespace twinray
