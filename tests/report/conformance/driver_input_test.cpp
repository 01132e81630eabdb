// SPDX-License-Identifier: MIT
#include "report/conformance/driver_input.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/core/error.h"

namespace twinray::conformance {
namespace {

template <class T>
T at(const std::vector<std::byte>& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

GeometryInput triangle() {
    return {.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, -0.5f)}, .triangles = {uvec3(2, 1, 0)}};
}

TEST(ConformanceInput, VerticesAreInTheirFormat) {
    GeometryInput geometry = triangle();
    EXPECT_EQ(vertex_stride(geometry), 12u);
    EXPECT_EQ(at<float>(encoded_vertices(geometry), 2 * 12 + 8), -0.5f);
    geometry.format = VK_FORMAT_R16G16B16A16_SNORM;
    geometry.padding = 4;
    EXPECT_EQ(vertex_stride(geometry), 12u);
    EXPECT_EQ(at<std::int16_t>(encoded_vertices(geometry), 12), 32767);
    EXPECT_EQ(at<std::int16_t>(encoded_vertices(geometry), 2 * 12 + 4), -16384);
    geometry.format = VK_FORMAT_R16G16_SFLOAT;
    geometry.padding = 0;
    EXPECT_EQ(vertex_stride(geometry), 4u);
    EXPECT_EQ(at<std::uint16_t>(encoded_vertices(geometry), 4), 0x3c00) << "1 as a half";
    geometry.format = VK_FORMAT_R8_UNORM;
    EXPECT_THROW(encoded_vertices(geometry), Error);
}

TEST(ConformanceInput, WhatIsPassedOverComesFirst) {
    GeometryInput geometry = triangle();
    geometry.first_vertex = 2;
    EXPECT_EQ(encoded_vertices(geometry).size(), (2u + 3 + 2) * 12);
    EXPECT_EQ(at<float>(encoded_vertices(geometry), 3 * 12), 1) << "the second of the triangle's";
    geometry.indices = Indices::bits16;
    geometry.earlier_items = 2;
    EXPECT_EQ(encoded_indices(geometry).size(), 3u * 6);
    EXPECT_EQ(at<std::uint16_t>(encoded_indices(geometry), 12), 2);
    geometry.indices = Indices::none;
    EXPECT_TRUE(encoded_indices(geometry).empty());
    EXPECT_EQ(encoded_vertices(geometry).size(), (2u + 6 + 3 + 2) * 12);
    const GeometryInput boxes{.boxes = {{vec3(0), vec3(1)}}, .padding = 8, .earlier_items = 1};
    EXPECT_EQ(encoded_boxes(boxes).size(), 2u * 32);
    EXPECT_EQ(at<float>(encoded_boxes(boxes), 32 + 12), 1);
}

}  // namespace
}  // namespace twinray::conformance
