// SPDX-License-Identifier: MIT
// Arrays that are given to NumPy: nothing is written before what is computed.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#include <sys/mman.h>

namespace twinray::python {

// Large ones lie in huge pages where the system has them, as NumPy's do: to touch 20 MB first in pages of 4 KB takes
// half as long as to trace a million rays.
template <class T>
class Column {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Column() = default;
    explicit Column(std::size_t count) : items_(static_cast<T*>(allocate(count * sizeof(T)))), count_(count) {}
    std::size_t size() const { return count_; }
    T* data() const { return items_.get(); }
    T& operator[](std::size_t i) const { return items_.get()[i]; }

  private:
    static void* allocate(std::size_t bytes) {
        constexpr std::size_t huge = std::size_t{2} << 20;
        const std::size_t alignment = bytes < huge ? alignof(std::max_align_t) : huge;
        const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
        void* memory = std::aligned_alloc(alignment, rounded ? rounded : alignment);
        if (!memory) throw std::bad_alloc();
        if (alignment == huge) madvise(memory, rounded, MADV_HUGEPAGE);
        return memory;
    }
    struct Free {
        void operator()(T* items) const { std::free(items); }
    };
    std::unique_ptr<T, Free> items_;
    std::size_t count_ = 0;
};

// Vectors of ours are 0 where they begin.
struct Numbers2 {
    float x, y;
};
struct Numbers3 {
    float x, y, z;
};

}  // namespace twinray::python
