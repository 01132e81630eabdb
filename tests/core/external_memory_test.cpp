// SPDX-License-Identifier: MIT
// A mesh in memory that one device made and another builds from, as programs of two APIs would.
#include <unistd.h>

#include <cmath>

#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

using test::down;
using test::error_if_any;
using test::square;

class SharedMemory : public test::AccelTest {
  protected:
    void write(Context& other, const Buffer& buffer, const std::vector<vec3>& positions) {
        Commands commands(other, "other program");
        {
            const auto pass = commands.pass("write");
            commands.upload(buffer, std::span<const vec3>(positions));
        }
        other.wait(commands.submit());
    }
};
TWINRAY_OVER_EVERY_ACCEL(SharedMemory);

TEST_P(SharedMemory, AMeshOfAnotherDeviceIsTracedAndFollowsIt) {
    if (!context().properties().external_memory_fd) TWINRAY_LACKS("external_memory", "no VK_KHR_external_memory_fd");
    const auto other = test::make_context();
    if (!other) return;
    Mesh mesh = square(0);
    const Buffer theirs = Buffer::exportable(*other, {.name = "theirs", .bytes = mesh.positions.size() * sizeof(vec3)});
    write(*other, theirs, mesh.positions);
    const Buffer ours = Buffer::imported(context(), {.name = "ours", .bytes = theirs.bytes()}, theirs.exported());
    EXPECT_EQ(download<vec3>(context(), ours, mesh.positions.size()), mesh.positions);
    const Buffer indices = device_copy(mesh.triangles);
    const AccelHandle handle = accel().push(DeviceMesh{.name = "shared",
                                                       .positions = ours.address(),
                                                       .vertex_count = mesh.positions.size(),
                                                       .indices = indices.address(),
                                                       .triangle_count = mesh.triangles.size(),
                                                       .in_place = true});
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 10.0f);
    for (vec3& p : mesh.positions) p.z = 3;
    write(*other, theirs, mesh.positions);
    accel().mark_vertices_dirty(handle);
    EXPECT_EQ(closest(down(0.5f, 0.25f)).t, 7.0f);
}

TEST_P(SharedMemory, WhatCannotBeSharedIsRefused) {
    if (!context().properties().external_memory_fd) TWINRAY_LACKS("external_memory", "no VK_KHR_external_memory_fd");
    const Buffer own(context(), {.name = "own", .bytes = 64});
    EXPECT_NE(error_if_any([&] { own.exported(); }).find("buffer 'own' is not exportable"), std::string::npos);
    EXPECT_NE(error_if_any([&] {
                  Buffer::exportable(context(), {.name = "mapped", .bytes = 64, .memory = Memory::upload});
              }).find("buffer 'mapped' to be shared: only memory of the device"),
              std::string::npos);
    EXPECT_NE(
        error_if_any([&] { Buffer::imported(context(), {.name = "none", .bytes = 64}, {}); }).find("descriptor -1"),
        std::string::npos);
    const Buffer small = Buffer::exportable(context(), {.name = "small", .bytes = 64});
    const ExportedMemory exported = small.exported();
    EXPECT_NE(error_if_any([&] {
                  Buffer::imported(context(), {.name = "large", .bytes = 1 << 20}, exported);
              }).find("bytes were exported; 1048576 are needed"),
              std::string::npos);
    EXPECT_EQ(close(exported.fd), 0) << "the descriptor is no longer the caller's";
}

}  // namespace
}  // namespace twinray
