// The viewer without its window: the effects of events, and the contents of its frames.
#include "viewer/viewer.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/accel/accel_fixture.h"
#include "tests/scene/temp_dir.h"
#include "twinray/glsl/vector_math.h"
#include "viewer/layers.h"

namespace twinray::viewer {
namespace {

constexpr uint width = 64, height = 48;

// Two boxes beside each other, and a folder for them.
class ViewerTest : public test::VulkanTest {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        write_boxes(2);
    }
    void write_boxes(int count) {
        std::ofstream out(file());
        for (int i = 0; i < count; ++i)
            for (int corner = 0; corner < 8; ++corner)
                out << "v " << (corner & 1 ? 1 : 0) + 2 * i << ' ' << (corner & 2 ? 1 : 0) << ' '
                    << (corner & 4 ? 1 : 0) << '\n';
        const int faces[][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
        for (int i = 0; i < count; ++i) {
            out << "o box" << i << '\n';
            for (const auto& f : faces)
                out << "f " << f[0] + 1 + 8 * i << ' ' << f[1] + 1 + 8 * i << ' ' << f[2] + 1 + 8 * i << '\n';
        }
    }
    std::filesystem::path file() const { return folder_ / "boxes.obj"; }

    // Looks from the front, with the first box on the left.
    ViewerDesc desc(Layer layer = Layer::eyelight) {
        State state;
        state.layer = layer;
        state.width = width, state.height = height;
        return {.file = file(),
                .state = state,
                .camera = std::array{dvec3(1.5, 0.5, 6), dvec3(1.5, 0.5, 0)},
                .say = [this](const std::string& line) { said.push_back(line); },
                .version = "test"};
    }
    std::vector<std::string> said;
    const test::TempDir folder_;
};

void drag(Viewer& viewer, double from_x, double from_y, double to_x, double to_y, bool with_shift = false) {
    viewer.handle(ButtonDown{Button::left, from_x, from_y, with_shift});
    viewer.handle(Moved{to_x, to_y});
    viewer.handle(ButtonUp{Button::left});
}
void click(Viewer& viewer, uvec2 pixel) {
    viewer.handle(ButtonDown{Button::left, pixel.x + 0.5, pixel.y + 0.5});
    viewer.handle(ButtonUp{Button::left});
}

constexpr uvec2 on_first{20, 24}, on_second{44, 24}, on_nothing{32, 2};

Rgb at(const Raster& raster, uvec2 pixel) { return raster.at(pixel.x, pixel.y); }
double number_at(const Viewer& viewer, uvec2 pixel) {
    return viewer.values().numbers[std::size_t{pixel.y} * width + pixel.x];
}
std::size_t count_unlike(const Raster& a, const Raster& b) {
    std::size_t unlike = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) unlike += a.pixels[i] != b.pixels[i];
    return unlike;
}

TEST_F(ViewerTest, LayersTellMeshesNormalsAndMisses) {
    Viewer viewer(context(), desc());
    const auto shown = [&](const char* key) {
        viewer.handle(KeyDown{key});
        return viewer.frame(false);
    };
    const Raster occlusion = shown("F3");
    EXPECT_EQ(at(occlusion, on_nothing), background);
    EXPECT_EQ(at(occlusion, on_first), at(occlusion, on_second));
    EXPECT_NE(at(occlusion, on_first), background);
    const Raster normal = shown("F5");
    EXPECT_EQ(at(normal, on_first), (Rgb{128, 128, 255}));
    const Raster primitive = shown("F7");
    EXPECT_NE(at(primitive, on_first), at(primitive, on_second));
    const Raster depth = shown("F8");
    EXPECT_NE(at(depth, on_first), background);
    EXPECT_TRUE(viewer.figures().size() >= 5);
}

TEST_F(ViewerTest, BothAcceleratorsAreSeen) {
    Viewer viewer(context(), desc(Layer::primitive));
    if (!viewer.stage().hardware()) TWINRAY_LACKS("ray_tracing", viewer.stage().why_no_hardware());
    const Raster software = viewer.frame(false);
    viewer.handle(KeyDown{"Tab"});
    EXPECT_EQ(viewer.state().shown, Shown::hardware);
    const Raster hardware = viewer.frame(false);
    viewer.handle(KeyDown{"W"});
    const Raster wipe = viewer.frame(false);
    for (uint y = 0; y < height; ++y) {
        EXPECT_EQ(wipe.at(3, y), software.at(3, y));
        EXPECT_EQ(wipe.at(width - 3, y), hardware.at(width - 3, y));
        EXPECT_EQ(wipe.at(width / 2, y), ink) << "the wipe's line";
    }
    viewer.handle(KeyDown{"D"});
    (void)viewer.frame(false);
    EXPECT_EQ(viewer.disagreements(), count_unlike(software, hardware));
}

TEST_F(ViewerTest, ClicksExplainRays) {
    Viewer viewer(context(), desc());
    click(viewer, on_second);
    ASSERT_TRUE(viewer.picked());
    EXPECT_EQ(viewer.picked()->software.hit, 1u);
    EXPECT_EQ(viewer.picked()->software_class, HitClass::agree);
    EXPECT_GT(viewer.picked()->nodes, 0u);
    EXPECT_NEAR(viewer.picked()->point->z, 1, 1e-6);
    EXPECT_NE(viewer.explanation().find("exactly: hit"), std::string::npos) << viewer.explanation();
    EXPECT_EQ(viewer.state().picked, on_second);
    drag(viewer, 10, 10, 20, 10);  // is no click
    EXPECT_EQ(viewer.state().picked, on_second);
}

TEST_F(ViewerTest, DragsWheelAndKeysMoveTheCamera) {
    Viewer viewer(context(), desc());
    const Orbit before = viewer.state().orbit;
    drag(viewer, 10, 10, 34, 10);
    EXPECT_NEAR(viewer.state().orbit.azimuth, before.azimuth - std::acos(-1.0) * 0.5, 1e-9);
    EXPECT_EQ(viewer.state().orbit.center, before.center);
    drag(viewer, 10, 10, 34, 10, true);
    EXPECT_NE(viewer.state().orbit.center, before.center);
    viewer.handle(Scrolled{2});
    EXPECT_LT(viewer.state().orbit.distance, before.distance);
    viewer.handle(KeyDown{"1"});
    viewer.handle(KeyDown{"Home"});
    const double distance = viewer.state().orbit.distance;
    viewer.handle(DoubleClick{on_first.x + 4.0, on_first.y + 0.5});
    EXPECT_GT(viewer.state().orbit.center.z, 0.9) << "on the front of the box";
    EXPECT_EQ(viewer.state().orbit.distance, distance);
    const dvec3 center = viewer.state().orbit.center;
    viewer.handle(KeyDown{"W"});  // without the right button it wipes
    EXPECT_EQ(viewer.state().orbit.center, center);
    viewer.handle(ButtonDown{Button::right, 10, 10});
    viewer.handle(KeyDown{"W"});
    (void)viewer.frame(false);
    EXPECT_LT(viewer.state().orbit.center.z, center.z) << "it flies ahead";
    viewer.handle(KeyDown{"C"});
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0].rfind("--camera ", 0), 0u);
}

TEST_F(ViewerTest, FramesAreCoarseWhileItMovesAndWholeAtRest) {
    Viewer viewer(context(), desc(Layer::primitive));
    const Raster whole = viewer.frame(true);
    EXPECT_FALSE(viewer.is_refining());
    viewer.handle(ButtonDown{Button::left, 10, 10});
    viewer.handle(Moved{20, 12});
    (void)viewer.frame(true);
    viewer.handle(ButtonUp{Button::left});
    EXPECT_TRUE(viewer.is_refining());
    (void)viewer.frame(true);
    (void)viewer.frame(true);
    EXPECT_FALSE(viewer.is_refining());
    const State state = viewer.state();
    Viewer other(context(), desc(Layer::primitive));
    other.set_state(state);
    EXPECT_EQ(viewer.last().pixels, other.frame(false).pixels) << "a state is one picture, however it was reached";
    EXPECT_NE(whole.pixels, viewer.last().pixels);
}

TEST_F(ViewerTest, PathsGetBetterAndBeginAnew) {
    Viewer viewer(context(), desc(Layer::path));
    (void)viewer.frame(true);
    EXPECT_EQ(viewer.samples(), 0u) << "what can be seen at once comes first";
    for (int i = 0; i < 4; ++i) (void)viewer.frame(true);
    EXPECT_EQ(viewer.samples(), 4u);
    EXPECT_TRUE(viewer.is_refining());
    const std::vector<Rgb> needed = viewer.last().pixels;
    viewer.handle(KeyDown{"A"});
    (void)viewer.frame(true);
    for (int i = 0; i < 4; ++i) (void)viewer.frame(true);
    EXPECT_EQ(viewer.samples(), 4u);
    EXPECT_EQ(viewer.last().pixels, needed) << "what is left out is not seen";
    viewer.handle(Scrolled{1});
    (void)viewer.frame(false);
    EXPECT_EQ(viewer.samples(), 1u);
}

TEST_F(ViewerTest, TreesAreDrawnLevelByLevel) {
    write_boxes(40);
    Viewer viewer(context(), desc());
    const auto boxes = [&](int depth) {
        return boxes_at(viewer.stage().scene(), viewer.stage().cpu_reference(), depth);
    };
    ASSERT_EQ(boxes(0).size(), 1u);
    std::size_t before = 1;
    for (int depth = 1; depth < 4; ++depth) {
        EXPECT_GT(boxes(depth).size(), before);
        before = boxes(depth).size();
    }
    const Box root = boxes(0)[0];
    for (const Box& box : boxes(3)) {  // within the root, but for the rounding of planes
        EXPECT_GE(box.lo.x, root.lo.x - 0.01 * (root.hi.x - root.lo.x));
        EXPECT_LE(box.hi.x, root.hi.x + 0.01 * (root.hi.x - root.lo.x));
    }
    EXPECT_EQ(root.share, 1);
    for (const Box& box : boxes(3)) {
        const dvec3 size = box.hi - box.lo, all = root.hi - root.lo;
        const double area = size.x * size.y + size.y * size.z + size.z * size.x;
        EXPECT_NEAR(box.share, area / (all.x * all.y + all.y * all.z + all.z * all.x), 1e-12);
    }
    EXPECT_NE(strokes_of(boxes(3), BoxColor::area)[0].color, strokes_of(boxes(3), BoxColor::kind)[0].color);
    EXPECT_LE(boxes_at(viewer.stage().scene(), viewer.stage().cpu_reference(), 20, 10).size(), 10u);
    viewer.handle(KeyDown{"["});
    EXPECT_FALSE(viewer.state().tree_depth);
    const Raster without = viewer.frame(false);
    viewer.handle(KeyDown{"]"});
    EXPECT_EQ(viewer.state().tree_depth, 0);
    EXPECT_NE(viewer.frame(false).pixels, without.pixels);
}

TEST_F(ViewerTest, StepsAreMoreWhereThereIsSomethingToFind) {
    Viewer viewer(context(), desc(Layer::steps));
    (void)viewer.frame(false);
    ASSERT_TRUE(viewer.values().scale);
    EXPECT_GT(number_at(viewer, on_first), number_at(viewer, uvec2(0, 0)));
    EXPECT_GE(viewer.values().scale->hi(), number_at(viewer, on_first));
}

TEST_F(ViewerTest, OrthographicEyesStandOutside) {
    Viewer viewer(context(), desc(Layer::normal));
    viewer.handle(KeyDown{"5"});
    for (int i = 0; i < 12; ++i) viewer.handle(Scrolled{1});
    EXPECT_EQ(at(viewer.frame(false), uvec2(width / 2, height / 2)), background) << "between the boxes";
    drag(viewer, 10, 10, 10.0 + width, 10, true);
    EXPECT_EQ(at(viewer.frame(false), uvec2(width / 2, height / 2)), (Rgb{128, 128, 255}))
        << "the front, not the inside";
}

TEST_F(ViewerTest, ADoubleClickIsNoClick) {
    Viewer viewer(context(), desc());
    click(viewer, on_first);
    const std::optional<Pick> first = viewer.picked();
    viewer.handle(DoubleClick{on_first.x + 0.5, on_first.y + 0.5});
    click(viewer, on_first);
    EXPECT_EQ(viewer.picked()->ray.direction, first->ray.direction);
    viewer.handle(KeyDown{"B"});
    EXPECT_EQ(said.back().find("--pick"), std::string::npos) << "the pixel was another camera's: " << said.back();
}

TEST_F(ViewerTest, GoesOnAfterAnError) {
    Viewer viewer(context(), desc(Layer::path));
    viewer.recover("what failed");
    (void)viewer.frame(true);
    EXPECT_EQ(viewer.message(), "what failed");
    EXPECT_EQ(viewer.state().layer, Layer::eyelight);
}

TEST_F(ViewerTest, LevelsAndCamerasAreOneAfterTheOther) {
    Viewer viewer(context(), desc(Layer::primitive));
    const Raster watertight = viewer.frame(false);
    if (!viewer.stage().has_level(Level::certified)) TWINRAY_LACKS("float64", "no float64");
    for (const Level level : {Level::refined, Level::certified}) {
        viewer.handle(KeyDown{"L"});
        EXPECT_EQ(viewer.state().level, level);
        EXPECT_LT(count_unlike(viewer.frame(false), watertight), 100u) << "rays that meet an edge differ";
    }
    viewer.handle(KeyDown{"L"});
    EXPECT_EQ(viewer.state().level, Level::fast);
    viewer.handle(KeyDown{"N"});
    EXPECT_EQ(viewer.message(), "the file has no camera");
}

TEST_F(ViewerTest, DistancesAreThoseOfThePlane) {
    Viewer viewer(context(), desc(Layer::distance));
    (void)viewer.frame(false);
    EXPECT_NEAR(number_at(viewer, uvec2(width / 2, height / 2)), 0.5, 0.1) << "between the boxes";
    EXPECT_NEAR(number_at(viewer, on_first), 0, 1e-12) << "the plane z = 0 is the backs of both";
    EXPECT_GT(number_at(viewer, uvec2(0, 0)), 0.5);
}

TEST_F(ViewerTest, AnalysesAreLayers) {
    Viewer viewer(context(), desc(Layer::light));
    (void)viewer.frame(false);
    ASSERT_EQ(viewer.values().numbers.size(), 24u);
    viewer.handle(KeyDown{"F11"});
    (void)viewer.frame(false);
    EXPECT_NE(viewer.message().find("click a face"), std::string::npos);
    click(viewer, on_first);
    (void)viewer.frame(false);
    EXPECT_EQ(viewer.values().numbers.size(), 24u);
    viewer.handle(KeyDown{"F12"});
    (void)viewer.frame(false);
    for (const double worst : viewer.values().numbers) EXPECT_TRUE(std::isnan(worst)) << "the boxes are apart";
}

TEST_F(ViewerTest, BadFilesAndNoPixelsLeaveItAsItIs) {
    Viewer viewer(context(), desc());
    const std::vector<Rgb> before = viewer.frame(false).pixels;
    viewer.handle(Dropped{folder_.write("garbage.glb", "no scene")});
    EXPECT_NE(viewer.message().find("garbage.glb"), std::string::npos) << viewer.message();
    EXPECT_EQ(viewer.frame(false).pixels, before);
    viewer.handle(Resized{0, 0});
    EXPECT_EQ(viewer.frame(false).pixels, before);
    std::ofstream(file()) << "garbage";
    viewer.handle(KeyDown{"R"});
    EXPECT_FALSE(viewer.message().empty());
    EXPECT_EQ(viewer.frame(false).pixels, before);
    write_boxes(3);
    std::filesystem::last_write_time(file(), std::filesystem::last_write_time(file()) + std::chrono::seconds(2));
    viewer.reload_if_changed();
    EXPECT_EQ(count_triangles(viewer.stage().scene()), 36u);
    viewer.handle(Resized{30, 20});
    EXPECT_EQ(viewer.frame(false).width, 30u);
    viewer.handle(Closed{});
    EXPECT_TRUE(viewer.is_closed());
}

}  // namespace
}  // namespace twinray::viewer
