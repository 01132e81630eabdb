// SPDX-License-Identifier: MIT
// Arithmetic on the vectors of <twinray/geometry.h>, done by GLM: the same operators and functions as in GLSL, so that
// headers of both languages compile as C++.
#pragma once

#include <glm/glm.hpp>

#include <type_traits>
#include <twinray/geometry.h>

namespace twinray {

template <class T>
glm::vec<2, T> to_glm(const Vec<2, T>& v) {
    return {v.x, v.y};
}
template <class T>
glm::vec<3, T> to_glm(const Vec<3, T>& v) {
    return {v.x, v.y, v.z};
}
template <class T>
glm::vec<4, T> to_glm(const Vec<4, T>& v) {
    return {v.x, v.y, v.z, v.w};
}

#define TWINRAY_OPERATOR(op)                                               \
    template <int N, class T>                                              \
    Vec<N, T> operator op(const Vec<N, T>& a, const Vec<N, T>& b) {        \
        return to_glm(a) op to_glm(b);                                     \
    }                                                                      \
    template <int N, class T>                                              \
    Vec<N, T> operator op(const Vec<N, T>& a, std::type_identity_t<T> b) { \
        return to_glm(a) op b;                                             \
    }                                                                      \
    template <int N, class T>                                              \
    Vec<N, T> operator op(std::type_identity_t<T> a, const Vec<N, T>& b) { \
        return a op to_glm(b);                                             \
    }                                                                      \
    template <int N, class T>                                              \
    Vec<N, T>& operator op##=(Vec<N, T>& a, const Vec<N, T>& b) {          \
        return a = a op b;                                                 \
    }                                                                      \
    template <int N, class T>                                              \
    Vec<N, T>& operator op##=(Vec<N, T>& a, std::type_identity_t<T> b) {   \
        return a = a op b;                                                 \
    }
TWINRAY_OPERATOR(+)
TWINRAY_OPERATOR(-)
TWINRAY_OPERATOR(*)
TWINRAY_OPERATOR(/)
TWINRAY_OPERATOR(%)
TWINRAY_OPERATOR(&)
TWINRAY_OPERATOR(|)
TWINRAY_OPERATOR(^)
TWINRAY_OPERATOR(<<)
TWINRAY_OPERATOR(>>)
#undef TWINRAY_OPERATOR

template <int N, class T>
Vec<N, T> operator-(const Vec<N, T>& v) {
    return -to_glm(v);
}
template <int C, int R, class T>
Vec<R, T> operator*(const glm::mat<C, R, T>& m, const Vec<C, T>& v) {
    return m * to_glm(v);
}
template <int C, int R, class T>
Vec<C, T> operator*(const Vec<R, T>& v, const glm::mat<C, R, T>& m) {
    return to_glm(v) * m;
}

#define TWINRAY_FUNCTION(name)                      \
    using glm::name;                                \
    template <int N, class T>                       \
    auto name(const Vec<N, T>& v) {                 \
        return result_of_glm(glm::name(to_glm(v))); \
    }
#define TWINRAY_FUNCTION_OF_2(name)                            \
    using glm::name;                                           \
    template <int N, class T>                                  \
    auto name(const Vec<N, T>& a, const Vec<N, T>& b) {        \
        return result_of_glm(glm::name(to_glm(a), to_glm(b))); \
    }
template <class T>
T result_of_glm(T number) {
    return number;
}
template <int N, class T>
requires(!std::same_as<T, bool>) Vec<N, T> result_of_glm(const glm::vec<N, T>& v) { return v; }
TWINRAY_FUNCTION(abs)
TWINRAY_FUNCTION(sign)
TWINRAY_FUNCTION(floor)
TWINRAY_FUNCTION(ceil)
TWINRAY_FUNCTION(round)
TWINRAY_FUNCTION(fract)
TWINRAY_FUNCTION(sqrt)
TWINRAY_FUNCTION(exp)
TWINRAY_FUNCTION(exp2)
TWINRAY_FUNCTION(log)
TWINRAY_FUNCTION(isnan)
TWINRAY_FUNCTION(isinf)
TWINRAY_FUNCTION(length)
TWINRAY_FUNCTION(normalize)
TWINRAY_FUNCTION_OF_2(min)
TWINRAY_FUNCTION_OF_2(max)
TWINRAY_FUNCTION_OF_2(pow)
TWINRAY_FUNCTION_OF_2(dot)
TWINRAY_FUNCTION_OF_2(cross)
TWINRAY_FUNCTION_OF_2(distance)
TWINRAY_FUNCTION_OF_2(reflect)
TWINRAY_FUNCTION_OF_2(lessThan)
TWINRAY_FUNCTION_OF_2(lessThanEqual)
TWINRAY_FUNCTION_OF_2(greaterThan)
TWINRAY_FUNCTION_OF_2(greaterThanEqual)
TWINRAY_FUNCTION_OF_2(equal)
TWINRAY_FUNCTION_OF_2(notEqual)
#undef TWINRAY_FUNCTION
#undef TWINRAY_FUNCTION_OF_2
using glm::all;
using glm::any;

template <int N, class T>
Vec<N, T> min(const Vec<N, T>& a, std::type_identity_t<T> b) {
    return glm::min(to_glm(a), b);
}
template <int N, class T>
Vec<N, T> max(const Vec<N, T>& a, std::type_identity_t<T> b) {
    return glm::max(to_glm(a), b);
}
using glm::clamp;
template <int N, class T>
Vec<N, T> clamp(const Vec<N, T>& v, std::type_identity_t<T> low, std::type_identity_t<T> high) {
    return glm::clamp(to_glm(v), low, high);
}
template <int N, class T>
Vec<N, T> clamp(const Vec<N, T>& v, const Vec<N, T>& low, const Vec<N, T>& high) {
    return glm::clamp(to_glm(v), to_glm(low), to_glm(high));
}
using glm::mix;
template <int N, class T>
Vec<N, T> mix(const Vec<N, T>& a, const Vec<N, T>& b, std::type_identity_t<T> t) {
    return glm::mix(to_glm(a), to_glm(b), t);
}
template <int N, class T>
Vec<N, T> mix(const Vec<N, T>& a, const Vec<N, T>& b, const Vec<N, T>& t) {
    return glm::mix(to_glm(a), to_glm(b), to_glm(t));
}
using glm::findLSB;
using glm::umulExtended;

}  // namespace twinray
