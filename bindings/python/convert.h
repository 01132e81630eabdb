// Arrays of Python's packages as twinray's and back, and calls without Python's lock: what all bindings share.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings/python/scene.h"

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

// Makes an array that owns its memory, of `columns` numbers of type T a row; 0: one number, without the second axis.
template <class T, class Rows>
nb::object given(Rows&& rows, std::size_t columns = 0) {
    auto owner = std::make_unique<Rows>(std::move(rows));
    const std::size_t shape[] = {owner->size(), columns};
    auto* data = reinterpret_cast<T*>(owner->data());
    nb::capsule capsule(owner.get(), [](void* p) noexcept { delete static_cast<Rows*>(p); });
    owner.release();
    return nb::cast(nb::ndarray<nb::numpy, T>(data, columns ? 2 : 1, shape, capsule));
}

template <class T>
using RayArray = Rows<T, 6>;
using Vector = std::array<double, 3>;

inline dvec3 vector_of(const Vector& v) { return {v[0], v[1], v[2]}; }

template <class T>
RayRows rows_of(const RayArray<T>& array, const Vector& origin, double t_near = 0,
                double t_far = std::numeric_limits<double>::infinity()) {
    RayRows rows{.origin = vector_of(origin), .t_near = t_near, .t_far = t_far};
    const std::span<const T> numbers(array.data(), 6 * array.shape(0));
    if constexpr (std::is_same_v<T, float>)
        rows.floats = numbers;
    else
        rows.doubles = numbers;
    return rows;
}

bool no_signal_ends_it();  // whether a call may go on; the GIL may be released

// Calls without the GIL, so that others go on while the device works. Ctrl-C ends the call.
template <class Call>
auto unlocked(const Call& call) {
    try {
        const nb::gil_scoped_release released;
        const InterruptScope scope(&no_signal_ends_it);
        return call();
    } catch (const Interrupted&) {
        throw nb::python_error();  // the one of the signal's handler
    }
}

void bind_analysis(nb::module_& m);

}  // namespace twinray::python
