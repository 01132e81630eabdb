// Parts of the viewer that need no device: cameras that turn, keys and events.
#include "viewer/state.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/scene/temp_dir.h"

#include "viewer/events.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/layers.h"
#include "viewer/files.h"

namespace twinray::viewer {
namespace {

TEST(Orbit, TurnsAboutItsCentre) {
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        Orbit orbit{.center = dvec3(1, 2, 3), .distance = 5, .up = up};
        for (int i = 0; i < 40; ++i) {
            orbit = turned(orbit, 0.13, 0.07);
            EXPECT_NEAR(length(eye_of(orbit) - orbit.center), 5, 1e-12);
            const Directions axes = directions_of(orbit);
            EXPECT_NEAR(dot(axes.right, axes.up), 0, 1e-12);
            EXPECT_NEAR(length(cross(axes.right, axes.up) + axes.forward), 0, 1e-12);
            EXPECT_GT(up == UpAxis::y ? axes.up.y : axes.up.z, 0) << "it never stands on its head";
        }
    }
}

TEST(Orbit, LooksFromWhereAxisViewsSay) {
    const Orbit y, z{.up = UpAxis::z};
    EXPECT_NEAR(eye_of(seen_from(y, Side::front)).z, 1, 1e-12);
    EXPECT_NEAR(eye_of(seen_from(y, Side::right)).x, 1, 1e-12);
    EXPECT_NEAR(eye_of(seen_from(y, Side::top)).y, 1, 1e-3);
    EXPECT_NEAR(eye_of(seen_from(z, Side::front)).y, -1, 1e-12);
    EXPECT_NEAR(eye_of(seen_from(z, Side::right)).x, 1, 1e-12);
    EXPECT_NEAR(eye_of(seen_from(z, Side::top)).z, 1, 1e-3);
}

TEST(Orbit, FramesAllOfABox) {
    const Bounds box = Bounds{vec3(-3, 10, 4), vec3(5, 12, 5)};
    for (const double aspect : {0.4, 1.0, 2.5})
        for (const bool is_orthographic : {false, true}) {
            Orbit orbit = framed(turned({}, 0.2, 0.1), box, aspect);
            orbit.is_orthographic = is_orthographic;
            const ImagePlane plane = image_plane(camera_of(orbit), static_cast<float>(aspect));
            double largest = 0;
            for (unsigned i = 0; i < 8; ++i) {
                const dvec3 corner((i & 1u ? box.hi : box.lo).x, (i & 2u ? box.hi : box.lo).y,
                                   (i & 4u ? box.hi : box.lo).z);
                const auto seen = project(plane, corner);
                ASSERT_TRUE(seen);
                largest = std::max({largest, std::abs(double(seen->point.x)), std::abs(double(seen->point.y))});
            }
            EXPECT_LE(largest, 1.0 + 1e-6);
            EXPECT_GT(largest, 0.4) << "it fills the picture";
        }
}

TEST(Orbit, PansWithThePointer) {
    const Orbit before = turned({.distance = 4}, 0.3, -0.1), after = panned(before, 0.25, -0.125);
    const ImagePlane plane = image_plane(camera_of(after), 1);
    const auto seen = project(plane, before.center);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->point.x, 0.5, 1e-6);
    EXPECT_NEAR(seen->point.y, -0.25, 1e-6);
}

TEST(Orbit, KeepsACamerasView) {
    const Camera camera = look_camera(vec3(3, 2, 8), vec3(1, 1, 1), vec3(0, 1, 0), 35);
    const Orbit orbit = orbit_of(camera, Bounds{vec3(-1), vec3(2)}, UpAxis::y);
    const Camera again = camera_of(orbit);
    for (std::size_t row = 0; row < 3; ++row)
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(camera.camera_to_world.rows[row][i], again.camera_to_world.rows[row][i], 1e-5);
    EXPECT_THROW(looking(dvec3(1), dvec3(1), UpAxis::y, 0.7), Error);
}

TEST(Orbit, OptionsShowTheSame) {
    const Orbit orbit = turned({.center = dvec3(1, -2, 0.5), .distance = 3}, 0.2, 0.1);
    const std::string options = options_of(orbit, dvec3(500000, 0, 0));
    double e[3], c[3], fov = 0;
    ASSERT_EQ(std::sscanf(options.c_str(), "--camera %lf %lf %lf %lf %lf %lf --fov %lf", e, e + 1, e + 2, c, c + 1,
                          c + 2, &fov),
              7)
        << options;
    const dvec3 origin(500000, 0, 0);
    const Orbit again = looking(dvec3(e[0], e[1], e[2]) - origin, dvec3(c[0], c[1], c[2]) - origin, UpAxis::y,
                                fov * std::numbers::pi / 180);
    EXPECT_NEAR(length(eye_of(again) - eye_of(orbit)), 0, 1e-9);
    EXPECT_NEAR(again.vertical_fov, orbit.vertical_fov, 1e-8);
}

TEST(Keys, EachHasOneMeaning) {
    std::set<std::string_view> names;
    std::set<Layer> layers;
    for (const Key& key : all_keys()) {
        EXPECT_TRUE(names.insert(key.name).second) << key.name;
        EXPECT_EQ(find_key(key.name), &key);
        if (key.action == Action::layer) layers.insert(key.layer);
    }
    EXPECT_EQ(layers.size(), all_layers.size()) << "each layer has a key";
    EXPECT_EQ(find_key("F13"), nullptr);
    State state;
    state.tree_depth = 4;
    EXPECT_EQ(state_of(*find_key("]"), state), "level 4");
    EXPECT_EQ(state_of(*find_key("F2"), state), "on");
    EXPECT_EQ(state_of(*find_key("F1"), state), "");
}

TEST(Events, AreWhatTheirTextSays) {
    const std::string text =
        "key F2\nkeyup A\ndown left 320 200 shift\nup middle\nmove 330 210.5\ndouble 3 4\nscroll -1\n"
        "resize 800 600\ndrop a b.glb\nframes 10\nshot x.png\nclose\n";
    const test::TempDir folder;
    const std::filesystem::path file = folder.write("events.txt", "# recorded\n\n" + text);
    std::string again;
    for (const Event& event : read_events(file)) again += text_of(event) + '\n';
    EXPECT_EQ(again, text);
    for (const char* bad : {"fly", "down both 1 2", "move 1", "resize 1 2 3", "scroll up", "frames -", "frames -1",
                            "key Foo", "keyup F99", "resize -1 5"}) {
        SCOPED_TRACE(bad);
        folder.write("events.txt", std::string("key A\n") + bad + '\n');
        test::expect_error("line 2", [&] { (void)read_events(file); });
    }
    EXPECT_THROW((void)read_events("nowhere.txt"), Error);
}

TEST(RecentFiles, TheLastComesFirst) {
    const test::TempDir folder;
    const std::filesystem::path list = folder / "state/recent";
    EXPECT_TRUE(recent_files(list).empty());
    for (int i = 0; i < 12; ++i) {
        keep_recent(list, folder.write(std::to_string(i) + ".glb", "x"));
    }
    keep_recent(list, folder / "9.glb");
    std::vector<std::filesystem::path> files = recent_files(list);
    ASSERT_EQ(files.size(), 8u);
    EXPECT_EQ(files[0], folder / "9.glb");
    EXPECT_EQ(files[1], folder / "11.glb");
    EXPECT_EQ(files[2], folder / "10.glb");
    EXPECT_EQ(files[3], folder / "8.glb");
    std::filesystem::remove(folder / "11.glb");
    EXPECT_EQ(recent_files(list)[1], folder / "10.glb");
    keep_recent({}, folder / "9.glb");  // nowhere to keep it
}

TEST(Layers, AgreementIsOfWhatIsHit) {
    const Hit a{1, 2.0f, 3, 0, 0.5f, 0.25f, 7, 0}, miss{0, -1, 0, 0, 0, 0, 0, 0};
    Hit b = a;
    b.t = 2.5f;
    EXPECT_TRUE(agree(a, b));
    b.primitive_index = 4;
    EXPECT_FALSE(agree(a, b));
    EXPECT_FALSE(agree(a, miss));
    EXPECT_TRUE(agree(miss, miss));
}

TEST(Layers, NumbersHaveColoursOfTheirOwn) {
    std::set<Rgb> colors;
    for (std::uint64_t i = 0; i < 1000; ++i) colors.insert(color_of_number(i));
    EXPECT_GT(colors.size(), 990u);
}

TEST(Layers, CoarsePixelsAreSquares) {
    Raster coarse(2, 2);
    coarse.at(1, 0) = {1, 2, 3};
    const Raster raster = enlarged(coarse, 5, 5, 3);
    EXPECT_EQ(raster.at(2, 2), paper);
    EXPECT_EQ(raster.at(3, 2), (Rgb{1, 2, 3}));
    EXPECT_EQ(raster.at(4, 0), (Rgb{1, 2, 3}));
    EXPECT_EQ(raster.at(4, 3), paper);
}

TEST(Bookmarks, LeaveOutWhatIsUsual) {
    State state;
    EXPECT_EQ(options_of(state, dvec3(0)).find("--show"), std::string::npos);
    state.shown = Shown::wipe;
    state.tree_depth = 3;
    state.picked = uvec2(4, 5);
    const std::string options = options_of(state, dvec3(0));
    for (const char* part : {"--show wipe", "--wipe 0.5", "--tree-depth 3", "--pick 4 5", "--layer eyelight"})
        test::expect_contains(options, part);
    EXPECT_EQ(options.find("--size"), std::string::npos);
}

}  // namespace
}  // namespace twinray::viewer
