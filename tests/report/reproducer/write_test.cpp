// Folders of reproducers, and the program in them with a ray that the driver answers correctly.
#include "report/reproducer/reproduce.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <optional>
#include <sstream>

#include <twinray/geometry.h>
#include <twinray/tlas.h>
#include "tests/scene/temp_dir.h"
#include "tests/support/device.h"
#include "report/replay/replay.h"
#include "report/reproducer/program.h"
#include "validation/verify/comparison.h"

namespace twinray::reproducer {
namespace {

namespace fs = std::filesystem;

// Makes a flat grid in which every coordinate is a whole number.
Scene grid_scene() {
    Mesh grid = make_grid(8, 8);
    for (vec3& position : grid.positions) position *= 8.0f;
    Scene scene;
    scene.meshes = {std::move(grid)};
    scene.instances = {{"", 0, Transform{}}};
    return scene;
}

class WriteTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!test::make_context()) {
            if (HasFailure()) FAIL() << "no device";
            return;
        }
        devices_ = std::make_unique<frame::Devices>(ContextDesc{.validation = true});
        if (!devices_->why_not({frame::Backend::ray_query, Level::watertight}).empty())
            TWINRAY_LACKS("ray_tracing", "the device has no ray queries");
    }
    // Returns a ray at a vertex that the driver loses, if there is one.
    std::optional<Ray> lost_ray(const Scene& scene) {
        const ReferenceScene reference = ReferenceScene::of(scene);
        const std::vector<Ray> rays = vertex_aimed_rays(Reference(scene), 4000, 1);
        AbstractAccel& accel = devices_->empty_accel({frame::Backend::ray_query, Level::watertight});
        push_scene(accel, scene);
        const std::vector<Hit> hits = accel.closest_hits(rays);
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (class_of(reference, rays[i], hits[i]) == HitClass::hw_leak) return rays[i];
        return {};
    }
    // Writes a replay file of the ray, and the scene beside it.
    fs::path replay_of(const std::string& name, const Scene& scene, const Ray& ray, const char* backend) {
        replay::write_glb(folder_ / "grid.glb", scene);
        const std::string hash = replay::hash_of(scene);
        replay::write(
            folder_ / name,
            {"grid.glb", hash, backend, "watertight", "HW_LEAK", ray, miss(), {}, "a device", "a driver", "a version"});
        return folder_ / name;
    }
    // Compiles the program without warnings and returns its exit status.
    int run(const std::string& program) {
        const fs::path source = folder_.write("program.c", program), file = folder_ / "program";
        const std::string compile = text(TWINRAY_C_COMPILER, " -std=c99 -Wall -Wextra -pedantic -Werror ",
                                         source.string(), " -lvulkan -o ", file.string());
        EXPECT_EQ(std::system(compile.c_str()), 0) << compile;
        const int status = std::system((file.string() + " > " + (folder_ / "said").string()).c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    test::TempDir folder_;
    std::unique_ptr<frame::Devices> devices_;
};

TEST_F(WriteTest, TheProgramTellsRightFromWrong) {
    const Scene scene = grid_scene();
    const Ray inside{vec3(0.625f, 2, 0.25f), 0, vec3(0, -1, 0), INFINITY}, beside{vec3(-1), 0, vec3(0, 1, 0), INFINITY};
    const RightAnswers hit = right_answers(ReferenceScene::of(scene), inside);
    EXPECT_EQ(run(program_text({scene, inside, hit, false, "a test"})), 0);
    EXPECT_EQ(run(program_text({scene, beside, hit, false, "a test"})), 1) << "a miss, where a hit is expected";
    const RightAnswers none = right_answers(ReferenceScene::of(scene), beside);
    EXPECT_EQ(run(program_text({scene, beside, none, false, "a test"})), 0);
    EXPECT_EQ(run(program_text({scene, inside, none, false, "a test"})), 1) << "a hit, where a miss is expected";
}

TEST_F(WriteTest, TheFirstOfEachClassIsWrittenAndTheRestPassedOver) {
    const Scene scene = grid_scene();
    const std::optional<Ray> lost = lost_ray(scene);
    if (!lost) GTEST_SKIP() << "this driver loses no ray at the vertices of a grid";
    const Ray inside{vec3(0.625f, 2, 0.25f), 0, vec3(0, -1, 0), INFINITY};
    const std::vector<fs::path> files = {replay_of("ours.json", scene, *lost, "sw"), folder_ / "missing.json",
                                         replay_of("right.json", scene, inside, "hw"),
                                         replay_of("lost.json", scene, *lost, "hw"),
                                         replay_of("again.json", scene, *lost, "hw")};
    std::ostringstream said;
    EXPECT_EQ(write_reproducers(folder_ / "out", files, *devices_, said), 1u);
    test::expect_contains(said.str(), "missing.json' cannot be opened");
    test::expect_contains(said.str(), "right.json': the driver's own answer is AGREE, which is no fault");
    test::expect_contains(said.str(), "HW_LEAK in ");
    for (const char* name : {"reproducer.c", "report.md", "replay.json", "scene.glb", "query.spv"})
        EXPECT_TRUE(fs::exists(folder_ / "out" / "HW_LEAK" / name)) << name;
    const replay::Replay replay = replay::read(folder_ / "out" / "HW_LEAK" / "replay.json");
    const Scene least = replay::load_traced_scene(folder_ / "out" / "HW_LEAK" / "replay.json", replay);
    EXPECT_LE(count_triangles(least), 4u);
    EXPECT_EQ(class_of(ReferenceScene::of(least), replay.ray, replay.answer), HitClass::hw_leak);

    std::ostringstream nothing;
    EXPECT_EQ(write_reproducers(folder_ / "late", files, *devices_, nothing, 0), 0u) << "the time is up";
    EXPECT_FALSE(fs::exists(folder_ / "late"));
}

}  // namespace
}  // namespace twinray::reproducer
