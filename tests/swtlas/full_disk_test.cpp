// SPDX-License-Identifier: MIT
// A full disk, imitated by the limit on the size of files.
#include <sys/resource.h>

#include <csignal>

#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "engine/core/files.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"

namespace twinray {
namespace {

using FullDisk = test::VulkanTest;

TEST_F(FullDisk, AFailedSaveLeavesTheOldFileAndNoOther) {
    SwTlas accel(context());
    accel.push(make_icosphere(4));
    context().wait(accel.sync());
    const test::TempDir folder;
    const std::filesystem::path file = folder.write("scene.swtlas", "old");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{20'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string what = test::error_of([&] { accel.save(file); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    test::expect_contains(what, "scene.swtlas': cannot be written: File too large");
    EXPECT_EQ(read_file(file), (Bytes{'o', 'l', 'd'}));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
    accel.save(file);
    EXPECT_EQ(SwTlas::load(context(), file).handles.size(), 1u);
}

}  // namespace
}  // namespace twinray
