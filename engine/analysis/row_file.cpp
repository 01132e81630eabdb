#include <twinray/analysis.h>

#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"

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
    // Returns nothing if the next row is not whole.
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

struct RowFile::State {
    std::filesystem::path file;
    std::string configuration;
    std::size_t first_row;
    std::ofstream out;
    std::optional<std::uint64_t> end;  // of the loaded rows

    void open_at(std::uint64_t bytes) {
        out.open(file, std::ios::binary | std::ios::app);
        std::error_code error;
        if (!out || std::filesystem::file_size(file, error) != bytes || error)
            fail("'", file.string(), "' cannot be written");
    }
};

RowFile::RowFile(std::filesystem::path file, const std::string& configuration, std::size_t first_row)
    : state_(new State{std::move(file), text(magic, configuration, '\n'), first_row, {}, {}}) {}
RowFile::~RowFile() = default;

std::vector<ViewFactorRow> RowFile::load() {
    if (!std::filesystem::exists(state_->file)) {
        create();
        return {};
    }
    const Bytes bytes = read_file(state_->file);
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), state_->configuration.size()));
    if (head != state_->configuration)
        fail("'", state_->file.string(), "': rows of another scene or of other options; they cannot be used");
    Reader reader(bytes);
    reader.skip(state_->configuration.size());
    std::vector<ViewFactorRow> rows;
    std::size_t whole = reader.at();
    while (std::optional<ViewFactorRow> row = reader.row()) {
        if (row->group != state_->first_row + rows.size()) break;
        rows.push_back(std::move(*row));
        whole = reader.at();
    }
    state_->end = whole;
    return rows;
}

void RowFile::create() {
    std::ofstream(state_->file, std::ios::binary | std::ios::trunc) << state_->configuration;
    state_->open_at(state_->configuration.size());
}

void RowFile::append(std::span<const ViewFactorRow> rows) {
    if (const auto end = std::exchange(state_->end, std::nullopt)) {
        std::filesystem::resize_file(state_->file, *end);
        state_->open_at(*end);
    }
    for (const ViewFactorRow& row : rows) {
        const std::vector<std::byte> bytes = bytes_of(row);
        state_->out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    if (!state_->out.flush()) fail("'", state_->file.string(), "' cannot be written");
}

void RowFile::remove() {
    state_->out.close();
    std::filesystem::remove(state_->file);
}

}  // namespace twinray
