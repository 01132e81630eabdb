// SPDX-License-Identifier: MIT
// NumPy arrays in and out: read where they lie, given away with what was computed.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

namespace twinray::python {

namespace nb = nanobind;

// Rows of N numbers; the Python side has cast and checked them.
template <class T, int N>
using Rows = nb::ndarray<const T, nb::shape<-1, N>, nb::c_contig, nb::device::cpu>;

// Rows as structs of the same numbers.
template <class Row, class Array>
std::span<const Row> as(const Array& rows) {
    static_assert(sizeof(Row) == 3 * sizeof(*rows.data()));
    return {reinterpret_cast<const Row*>(rows.data()), rows.shape(0)};
}

// An array that owns its memory, of `columns` numbers of type T a row; 0: one number, without the second axis.
template <class T, class Rows>
nb::object given(Rows&& rows, std::size_t columns = 0) {
    auto owner = std::make_unique<Rows>(std::move(rows));
    const std::size_t shape[] = {owner->size(), columns};
    auto* data = reinterpret_cast<T*>(owner->data());
    nb::capsule capsule(owner.get(), [](void* p) noexcept { delete static_cast<Rows*>(p); });
    owner.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(data, columns ? 2 : 1, shape, capsule));
}

}  // namespace twinray::python
