// Writes arrays for NumPy.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace twinray {

// An .npz file: a ZIP archive, not compressed, with one .npy file per array (numpy.lib.format, version 1.0), little
// endian.
class Npz {
  public:
    // `shape` empty: one dimension. The values must live until write(). Throws Error for more than 4 GiB of one array,
    // which needs another format.
    template <class T>
    void add(const std::string& name, std::span<const T> values, std::vector<std::size_t> shape = {}) {
        add(name, type_of(T{}), values.size(), std::as_bytes(values), std::move(shape));
    }
    void add_text(const std::string& name, const std::string& ascii);  // a scalar of bytes, as "S3"
    // Writes the whole file or nothing; throws Error naming it.
    void write(const std::filesystem::path& file) const;

  private:
    struct Member {
        std::string name;
        std::vector<std::byte> header;  // of the .npy, and the value of a text
        std::span<const std::byte> data;
    };
    static const char* type_of(std::uint8_t) { return "|u1"; }
    static const char* type_of(float) { return "<f4"; }
    static const char* type_of(double) { return "<f8"; }
    static const char* type_of(std::uint32_t) { return "<u4"; }
    static const char* type_of(std::int32_t) { return "<i4"; }
    static const char* type_of(std::int64_t) { return "<i8"; }
    static const char* type_of(std::uint64_t) { return "<u8"; }
    void add(const std::string& name, const std::string& type, std::size_t count, std::span<const std::byte> data,
             std::vector<std::size_t> shape);
    void add_member(const std::string& name, const std::string& type, const std::string& shape,
                    std::span<const std::byte> data);

    std::vector<Member> members_;
};

}  // namespace twinray
