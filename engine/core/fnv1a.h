// The hash FNV-1a of 64 bits (Fowler, Noll and Vo).
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace twinray {

class Fnv1a {
  public:
    // Adds a byte; or a word at once, which is faster and gives another hash.
    void add(std::uint64_t item) { value_ = (value_ ^ item) * 0x100000001b3u; }
    template <class T, std::size_t n>
    void add_bytes(std::span<T, n> items) {
        for (const std::byte byte : std::as_bytes(items)) add(static_cast<std::uint64_t>(byte));
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

// Returns 16 hexadecimal digits.
inline std::string hexadecimal(std::uint64_t hash) {
    std::string digits(16, '0');
    for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
    return digits;
}

}  // namespace twinray
