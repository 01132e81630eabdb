#include "engine/analysis/npz.h"

#include <bit>

#include "engine/core/error.h"
#include "engine/core/files.h"

namespace twinray {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::uint64_t most_bytes = 0xffff'0000;  // of a member, and of all: ZIP without its 64-bit extension

// Little-endian fields of ZIP's records (PKWARE APPNOTE 6.3).
class Record {
  public:
    Record& u16(std::uint64_t value) { return put(value, 2); }
    Record& u32(std::uint64_t value) { return put(value, 4); }
    Record& name(const std::string& text) {
        for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
        return *this;
    }
    const std::vector<std::byte>& bytes() const { return bytes_; }

  private:
    Record& put(std::uint64_t value, int count) {
        for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::byte>(value >> 8 * i));
        return *this;
    }
    std::vector<std::byte> bytes_;
};

constexpr std::uint64_t dos_date = 0x21;  // 1980-01-01: the same bytes whenever they are written

// Adds the fields of a member that the local header and the directory share.
void add_common(Record& record, const std::string& name, std::uint64_t sum, std::uint64_t bytes) {
    record.u16(20).u16(0).u16(0).u16(0).u16(dos_date);
    record.u32(sum).u32(bytes).u32(bytes).u16(name.size()).u16(0);
}

std::uint32_t checksum(std::uint32_t before, std::span<const std::byte> data) {
    return data.empty() ? before : crc32_of(data, before);  // a null pointer would begin anew
}

std::string shape_text(const std::vector<std::size_t>& shape) {
    std::string list;
    for (const std::size_t extent : shape) list += std::to_string(extent) + ", ";
    return "(" + list + ")";
}

}  // namespace

void Npz::add(const std::string& name, const std::string& type, std::size_t count, std::span<const std::byte> data,
              std::vector<std::size_t> shape) {
    if (shape.empty()) shape = {count};
    add_member(name, type, shape_text(shape), data);
}

void Npz::add_text(const std::string& name, const std::string& ascii) {
    add_member(name, "|S" + std::to_string(ascii.size()), "()", {});
    const auto bytes = std::as_bytes(std::span(ascii));
    members_.back().header.insert(members_.back().header.end(), bytes.begin(), bytes.end());
}

void Npz::add_member(const std::string& name, const std::string& type, const std::string& shape,
                     std::span<const std::byte> data) {
    if (data.size() > most_bytes)
        fail("array '", name, "': ", data.size(), " bytes; at most ", most_bytes, " fit into an .npz file, use .csv");
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
    constexpr std::size_t prefix = 10, alignment = 64;
    header.append(alignment - (prefix + header.size() + 1) % alignment, ' ');
    header += '\n';
    Record npy;
    npy.name("\x93NUMPY").u16(1).u16(header.size()).name(header);
    members_.push_back({name + ".npy", npy.bytes(), data});
}

void Npz::write(const std::filesystem::path& file) const {
    std::vector<Record> headers;
    Record directory;
    std::uint64_t at = 0;
    for (const Member& member : members_) {
        const std::uint64_t bytes = member.header.size() + member.data.size();
        const std::uint32_t sum = checksum(checksum(0, member.header), member.data);
        Record& header = headers.emplace_back();
        header.u32(0x04034b50);
        add_common(header, member.name, sum, bytes);
        header.name(member.name);
        directory.u32(0x02014b50).u16(20);
        add_common(directory, member.name, sum, bytes);
        directory.u16(0).u16(0).u16(0).u32(0).u32(at).name(member.name);
        at += header.bytes().size() + bytes;
        if (at > most_bytes) fail("'", file.string(), "': ", at, " bytes; at most ", most_bytes, " fit, use .csv");
    }
    Record end;
    end.u32(0x06054b50).u16(0).u16(0).u16(members_.size()).u16(members_.size());
    end.u32(directory.bytes().size()).u32(at).u16(0);
    std::vector<std::span<const std::byte>> pieces;
    for (std::size_t i = 0; i < members_.size(); ++i) {
        pieces.emplace_back(headers[i].bytes());
        pieces.emplace_back(members_[i].header);
        pieces.emplace_back(members_[i].data);
    }
    pieces.emplace_back(directory.bytes());
    pieces.emplace_back(end.bytes());
    write_file(file, pieces);
}

}  // namespace twinray
