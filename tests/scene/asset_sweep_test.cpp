// SPDX-License-Identifier: MIT
// Every scene file that this machine has: each loads or gives one Error that names it.
#include <twinray/scene.h>
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

// $TWINRAY_ASSETS, the assets beside the sources, or what Debian's assimp-testmodels installs.
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

}  // namespace
}  // namespace twinray::test
