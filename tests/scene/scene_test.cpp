// Meshes, shapes and scenes in memory; and all scene files on this machine, each of which loads or gives one Error that
// names it.
#include <twinray/scene.h>

#include "engine/scene/importers/faces.h"
#include "engine/scene/mesh.h"
#include "engine/scene/set_uploads.h"
#include "twinray/glsl/vector_math.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

Mesh mesh_of(std::vector<vec3> positions, std::vector<uvec3> triangles) {
    Mesh mesh;
    mesh.name = "m";
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return mesh;
}

TEST(Mesh, BoundsHoldTheVerticesThatTrianglesUse) {
    const Mesh mesh = mesh_of({{0, 0, 0}, {1, 2, 0}, {0, 0, -3}, {99, 99, 99}}, {{0, 1, 2}});
    EXPECT_EQ(bounds_of(mesh).lo, vec3(0, 0, -3));
    EXPECT_EQ(bounds_of(mesh).hi, vec3(1, 2, 0));
}

TEST(Mesh, BoundsLeaveOutNonFiniteVertices) {
    const Mesh mesh = mesh_of({{0, 0, 0}, {NAN, 50, 50}, {1, 1, 1}, {INFINITY, 0, 0}}, {{0, 1, 2}, {0, 2, 3}});
    EXPECT_EQ(bounds_of(mesh).lo, vec3(0));
    EXPECT_EQ(bounds_of(mesh).hi, vec3(1));
}

TEST(Mesh, BoundsOfNothingAreEmpty) {
    EXPECT_TRUE(bounds_of(mesh_of({{1, 1, 1}}, {})).is_empty());
    EXPECT_EQ(Bounds().size(), vec3(0));
}

// Normals of a cube with shared vertices are its diagonals, however its squares are cut.
TEST(Mesh, SmoothNormalsAreWeightedByAngles) {
    const auto cube = [](bool is_cut_otherwise) {
        std::vector<vec3> positions;
        for (int i = 0; i < 8; ++i) positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
        std::vector<uvec3> triangles;
        for (const auto& f :
             {std::array<uint, 4>{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}) {
            const std::size_t k = is_cut_otherwise ? 1 : 0;
            triangles.push_back({f[k], f[k + 1], f[k + 2]});
            triangles.push_back({f[k], f[k + 2], f[(k + 3) % 4]});
        }
        return mesh_of(std::move(positions), std::move(triangles));
    };
    for (const bool is_cut_otherwise : {false, true}) {
        const Mesh mesh = cube(is_cut_otherwise);
        const std::vector<vec3> normals = smooth_normals(mesh);
        for (std::size_t i = 0; i < 8; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(normals[i][k], mesh.positions[i][k] / std::sqrt(3.0f), 1e-7f);
    }
}

TEST(Mesh, SmoothNormalsOfTinyMeshesHaveADirectionAndOfNothingNone) {
    const float s = 1e-30f;
    const std::vector<vec3> normals = smooth_normals(
        mesh_of({{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {9, 9, 9}, {NAN, 0, 0}}, {{0, 1, 2}, {0, 0, 1}, {0, 1, 4}}));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(normals[static_cast<std::size_t>(i)], vec3(0, 0, 1));
    EXPECT_EQ(normals[3], vec3(0));
    EXPECT_EQ(normals[4], vec3(0));
}

TEST(Mesh, AnIndexOutOfRangeIsNamed) {
    const Mesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 3}});
    expect_error("mesh 'm': triangle 1 has vertex index 3, but the mesh has only 3 vertices",
                 [&] { check_indices(mesh); });
    EXPECT_NO_THROW(check_indices(mesh_of(mesh.positions, {{0, 1, 2}})));
}

TEST(Mesh, NonFiniteTrianglesAreCountedOnceEach) {
    const Mesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, NAN, INFINITY}, {0, 0, -INFINITY}},
                              {{0, 1, 1}, {0, 1, 2}, {3, 2, 3}, {2, 0, 1}});
    EXPECT_EQ(count_non_finite_triangles(mesh), 3u);
}

TEST(Weld, ExactlyEqualVerticesBecomeOneAndTrianglesKeepTheirOrder) {
    Mesh mesh =
        mesh_of({{0, 0, 0}, {1, 0, 0}, {1e-30f, 0, 0}, {-0.0f, 0, 0}, {1, 0, 0}}, {{0, 1, 2}, {3, 4, 2}, {0, 3, 1}});
    mesh.materials = {4, 5, 6};
    const Mesh welded = weld_equal_vertices(mesh);
    EXPECT_EQ(welded.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1e-30f, 0, 0}}));
    EXPECT_EQ(welded.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 1, 2}, {0, 0, 1}}));
    EXPECT_EQ(welded.materials, mesh.materials);
    EXPECT_EQ(welded.name, "m");
}

TEST(Weld, VerticesThatDifferInAnyAttributeStayApart) {
    Mesh mesh = mesh_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}});
    mesh.uvs = {{0, 0}, {1, 0}, {0, 0}};
    EXPECT_EQ(weld_equal_vertices(mesh).uvs, (std::vector<vec2>{{0, 0}, {1, 0}}));
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}};
    EXPECT_EQ(weld_equal_vertices(mesh).positions.size(), 3u);
    mesh.uvs.clear(), mesh.normals.clear();
    mesh.second_uvs = {{0, 0}, {1, 0}, {0, 0}};
    EXPECT_EQ(weld_equal_vertices(mesh).second_uvs, (std::vector<vec2>{{0, 0}, {1, 0}}));
    mesh.colors = {vec4(1), vec4(1), vec4(1, 1, 1, 0)};
    EXPECT_EQ(weld_equal_vertices(mesh).colors, mesh.colors);
}

TEST(Mesh, TheFirstTextureCoordinatesStandInForTheSecond) {
    Mesh mesh = mesh_of({{0, 0, 0}}, {});
    mesh.uvs = {{1, 2}};
    EXPECT_EQ(mesh.uv_set(0), mesh.uvs);
    EXPECT_EQ(mesh.uv_set(1), mesh.uvs);
    mesh.second_uvs = {{3, 4}};
    EXPECT_EQ(mesh.uv_set(0), mesh.uvs);
    EXPECT_EQ(mesh.uv_set(1), mesh.second_uvs);
}

TEST(Mesh, DirectionsAreUnitVectorsOrNone) {
    const dvec3 up(0, 0, 1), none(0);
    EXPECT_EQ(unit_or_zero({0, 0, 1e-45}), up);
    EXPECT_EQ(unit_or_zero({0, 0, 3e38}), up);
    EXPECT_EQ(unit_or_zero({0, 0, 0}), none);
    EXPECT_EQ(unit_or_zero({0, 0, INFINITY}), none);
    EXPECT_EQ(unit_or_zero({1, NAN, 0}), none);
}

TEST(Scene, BoundsAndCountsFollowTheInstances) {
    Scene scene;
    scene.meshes = {mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), mesh_of({}, {})};
    scene.instances = {
        {"a", 0, Transform::translation({5, 0, 0})}, {"b", 0, Transform::scaling({-2, 1, 1})}, {"c", 1, {}}};
    EXPECT_EQ(bounds_of(scene).lo, vec3(-2, 0, 0));
    EXPECT_EQ(bounds_of(scene).hi, vec3(6, 1, 0));
    EXPECT_EQ(count_triangles(scene), 2u);
}

TEST(Scene, BoundsAreThoseOfVerticesNotOfTurnedBoxes) {
    Scene scene;
    scene.meshes = {mesh_of({{0, 0, 0}, {1, 2, 4}, {1, 0, 4}}, {{0, 1, 2}})};
    // x' = x - y + z would be -2 at least for the box.
    scene.instances = {{"sheared", 0, {{vec4(1, -1, 1, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)}}}};
    EXPECT_EQ(bounds_of(scene).lo, vec3(0, 0, 0));
    EXPECT_EQ(bounds_of(scene).hi, vec3(5, 2, 4));
}

TEST(Scene, BoundsOfManyInstancesHoldAllVerticesAndNoMore) {
    constexpr float half = 0.70710677f;
    const Transform turned = {{vec4(half, -half, 0, 0), vec4(half, half, 0, 0), vec4(0, 0, 1, 0)}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-9, 9);
    Scene scene;
    scene.meshes = {mesh_of({{0, 1, 0}, {1, 0, 0}, {0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
                            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}})};
    dvec3 lo(INFINITY), hi(-INFINITY);
    for (int i = 0; i < 200; ++i) {
        Transform transform = turned;
        for (vec4& row : transform.rows) row.w = place(random);
        scene.instances.push_back({"", 0, transform});
        for (const vec3& point : scene.meshes[0].positions) {
            const dvec3 world(transform_point(transform, point));
            lo = min(lo, world), hi = max(hi, world);
        }
    }
    const Bounds bounds = bounds_of(scene);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(bounds.lo[i], lo[i], 1e-5);
        EXPECT_NEAR(bounds.hi[i], hi[i], 1e-5);
    }
}

TEST(Scene, UnknownSuffixesAreRefusedWithTheKnownOnes) {
    const TempDir dir;
    expect_error("unknown suffix '.fbx'; scenes are .gltf, .glb", [&] { load_scene(dir.write("a.fbx", "x")); });
    expect_error("unknown suffix '.glb.gz'", [&] { load_scene(dir.write("a.glb.gz", "x")); });
    expect_error("unknown suffix ''", [&] { load_scene(dir.write("a", "x")); });
}

// Returns $TWINRAY_ASSETS, the assets beside the sources, or what Debian's assimp-testmodels installs.
std::filesystem::path find_assets() {
    const char* given = std::getenv("TWINRAY_ASSETS");
    for (const std::filesystem::path& folder :
         {std::filesystem::path(given ? given : ""), std::filesystem::path(TWINRAY_SOURCE_DIR) / "../shared/assets",
          std::filesystem::path("/usr/share/assimp/models/glTF2")})
        if (!folder.empty() && std::filesystem::is_directory(folder)) return folder;
    return {};
}

bool is_scene(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    for (const char* suffix : {".gltf", ".glb", ".obj", ".ply", ".stl", ".gz"})
        if (name.ends_with(suffix)) return true;
    return false;
}

void expect_consistent(const Scene& scene) {
    ASSERT_FALSE(scene.materials.empty());
    EXPECT_GT(count_triangles(scene), 0u);
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(instance.mesh, scene.meshes.size());
        EXPECT_NE(determinant(instance.transform), 0);
    }
    for (const Mesh& mesh : scene.meshes) {
        EXPECT_NO_THROW(check_indices(mesh));
        EXPECT_FALSE(mesh.triangles.empty());
        for (const std::size_t size :
             {mesh.normals.size(), mesh.tangents.size(), mesh.uvs.size(), mesh.second_uvs.size(), mesh.colors.size()})
            EXPECT_TRUE(size == 0 || size == mesh.positions.size());
        ASSERT_EQ(mesh.materials.size(), mesh.triangles.size());
        for (const uint material : mesh.materials) ASSERT_LT(material, scene.materials.size());
    }
    for (const Material& material : scene.materials)
        EXPECT_LT(material.base_color_texture.image, static_cast<int>(scene.images.size()));
    for (const Image& image : scene.images) EXPECT_EQ(image.rgba.size(), std::size_t(4) * image.width * image.height);
}

TEST(AssetSweep, EveryFileLoadsOrGivesOneErrorThatNamesIt) {
    const std::filesystem::path assets = find_assets();
    if (assets.empty()) GTEST_SKIP() << "no assets: set TWINRAY_ASSETS or install assimp-testmodels";
    std::size_t loaded = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(assets)) {
        if (!entry.is_regular_file() || !is_scene(entry.path())) continue;
        SCOPED_TRACE(entry.path().string());
        try {
            expect_consistent(load_scene(entry.path()));
            ++loaded;
        } catch (const Error& e) {
            expect_contains(e.what(), entry.path().filename().string());
        }
    }
    EXPECT_GT(loaded, 0u);
}

double signed_volume(const Mesh& mesh) {
    double volume = 0;
    for (const uvec3& t : mesh.triangles)
        volume += double(dot(mesh.positions[t.x], cross(mesh.positions[t.y], mesh.positions[t.z]))) / 6;
    return volume;
}

// Every directed edge has its opposite exactly once.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<uint, uint>, int> edges;
    for (const uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
    }
    return true;
}

vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
    const uvec3 t = mesh.triangles[triangle];
    return normalize(cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

TEST(Shapes, TheQuadFacesAlongTheCrossOfItsEdges) {
    const Mesh quad = make_quad({1, 1, 1}, {2, 0, 0}, {0, 3, 0});
    EXPECT_EQ(quad.triangles.size(), 2u);
    EXPECT_EQ(face_normal(quad, 0), vec3(0, 0, 1));
    EXPECT_EQ(face_normal(quad, 1), vec3(0, 0, 1));
    EXPECT_EQ(quad.normals, std::vector<vec3>(4, vec3(0, 0, 1)));
    EXPECT_EQ(bounds_of(quad).hi, vec3(3, 4, 1));
}

TEST(Shapes, TheBoxFacesOutwards) {
    const Mesh box = make_box({-1, -2, -3}, {1, 2, 3});
    EXPECT_EQ(box.triangles.size(), 12u);
    EXPECT_NEAR(signed_volume(box), 48, 1e-5);
    EXPECT_EQ(bounds_of(box).lo, vec3(-1, -2, -3));
    EXPECT_EQ(bounds_of(box).hi, vec3(1, 2, 3));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(face_normal(box, i), box.normals[box.triangles[i].x]);
}

TEST(Shapes, TheIcosphereIsClosedRoundAndFacesOutwards) {
    for (const uint subdivisions : {0u, 1u, 4u}) {
        const Mesh sphere = make_icosphere(subdivisions, 2);
        EXPECT_EQ(sphere.triangles.size(), std::size_t(20) << 2 * subdivisions);
        EXPECT_EQ(sphere.positions.size(), (std::size_t(10) << 2 * subdivisions) + 2);
        EXPECT_TRUE(is_closed(sphere));
        EXPECT_GT(signed_volume(sphere), 0);
        for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
            EXPECT_NEAR(length(sphere.positions[i]), 2, 1e-6);
            EXPECT_NEAR(length(sphere.normals[i] * 2.0f - sphere.positions[i]), 0, 1e-6);
        }
    }
    EXPECT_NEAR(signed_volume(make_icosphere(4, 2)), 33.51, 0.15);
    expect_error("13 subdivisions; the limit is 12", [] { make_icosphere(13); });
}

TEST(Shapes, TheGridCoversTheUnitSquareFacingUp) {
    const Mesh grid = make_grid(4, 3);
    EXPECT_EQ(grid.triangles.size(), 24u);
    EXPECT_EQ(grid.positions.size(), 20u);
    EXPECT_EQ(grid.uvs.size(), 20u);
    EXPECT_EQ(bounds_of(grid).lo, vec3(0));
    EXPECT_EQ(bounds_of(grid).hi, vec3(1, 0, 1));
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(face_normal(grid, i), vec3(0, 1, 0));
    EXPECT_GT(bounds_of(make_grid(9, 9, 0.5f, 7)).hi.y, 0.25f);
    expect_error("grid: 0 x 3 cells", [] { make_grid(0, 3); });
    expect_error("fit into 32 bits", [] { make_grid(100000, 100000); });
}

TEST(Shapes, TheSoupIsSeparateTrianglesOfTheSizeAsked) {
    const Mesh soup = make_soup(500, 42, 0.25f);
    EXPECT_EQ(soup.positions.size(), 1500u);
    for (const uvec3& t : soup.triangles) EXPECT_LE(length(soup.positions[t.x] - soup.positions[t.y]), 0.5f);
    EXPECT_LT(length(bounds_of(soup).center() - vec3(0.5f)), 0.1f);
}

TEST(Shapes, TheSameSeedGivesTheSameBits) {
    EXPECT_EQ(make_soup(10, 1).positions, make_soup(10, 1).positions);
    EXPECT_NE(make_soup(10, 1).positions, make_soup(10, 2).positions);
    EXPECT_EQ(make_grid(5, 5, 1, 3).positions, make_grid(5, 5, 1, 3).positions);
    // The generator is part of the promise: recorded seeds must mean the same scene next year.
    EXPECT_EQ(make_grid(1, 1, 1, 5489).positions[0].y, static_cast<float>(3499211612u >> 8) * 0x1p-24f);
}

TEST(Shapes, TheCornellBoxHasALightAMetalAndAGlassThing) {
    const Scene scene = cornell_box_scene();
    EXPECT_EQ(scene.instances.size(), 8u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(bounds_of(scene).lo, vec3(-1));
    EXPECT_EQ(bounds_of(scene).hi, vec3(1));
    bool has_light = false, has_metal = false, has_glass = false;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        EXPECT_NO_THROW(check_indices(mesh));
        const Material& material = scene.materials.at(mesh.material(0));
        has_light |= material.emission.x > 1;
        has_metal |= material.metallic == 1;
        has_glass |= material.transmission == 1;
    }
    EXPECT_TRUE(has_light && has_metal && has_glass);
}

TEST(Shapes, TheCornellBoxFacesInwards) {
    const Scene scene = cornell_box_scene();
    for (std::size_t i = 0; i < 6; ++i) {  // walls and light; the camera looks in from +z
        const Mesh& mesh = scene.meshes[i];
        EXPECT_LT(dot(mesh.normals[0], mesh.positions[mesh.triangles[0].x]), 0) << mesh.name;
    }
}

TEST(SetUploads, NeighboursAreUploadedAsOneRegion) {
    EXPECT_EQ(runs_of({}), std::vector<ElementRun>{});
    EXPECT_EQ(runs_of({5}), (std::vector<ElementRun>{{5, 6}}));
    EXPECT_EQ(runs_of({7, 3, 4, 9, 8, 1}), (std::vector<ElementRun>{{1, 2}, {3, 5}, {7, 10}}));
}

TEST(SetUploads, ArraysGrowByDoublingAndNeverShrink) {
    EXPECT_EQ(grown_capacity(0, 0), 0u);
    EXPECT_EQ(grown_capacity(1, 0), 16u);
    EXPECT_EQ(grown_capacity(16, 16), 16u);
    EXPECT_EQ(grown_capacity(17, 16), 32u);
    EXPECT_EQ(grown_capacity(1000, 16), 1000u);
    EXPECT_EQ(grown_capacity(3, 1000), 1000u);
}

}  // namespace
}  // namespace twinray::test
