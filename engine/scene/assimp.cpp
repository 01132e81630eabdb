// SPDX-License-Identifier: MIT
// .obj and .stl through Assimp.
#include <algorithm>
#include <map>

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/image.h"
#include "engine/scene/importers.h"
#include "engine/scene/weld.h"

namespace twinray {
namespace {

// Turns one parsed file into a Scene.
class AssimpReader {
  public:
    AssimpReader(std::filesystem::path path, std::string format) : path_(std::move(path)), format_(std::move(format)) {}

    Scene read() {
        parse();
        check_source_indices();
        triangulate();
        for (unsigned i = 0; i < source_->mNumMaterials; ++i)
            scene_.materials.push_back(material_of(*source_->mMaterials[i]));
        for (unsigned i = 0; i < source_->mNumMeshes; ++i) read_mesh(i);
        place(*source_->mRootNode, aiMatrix4x4());
        return std::move(scene_);
    }

  private:
    void parse() {
        const std::string name = path_.string();
        if (lower_suffix(path_) == ".gz") {
            const Bytes unpacked = read_packed_file(path_);
            source_ = importer_.ReadFileFromMemory(unpacked.data(), unpacked.size(), 0, format_.c_str());
        } else {
            read_file(path_);  // for its plain words when there is no such file
            source_ = importer_.ReadFile(name, 0);
        }
        if (!source_ || !source_->mRootNode)
            fail("'", name, "': not a readable .", format_, " file (", importer_.GetErrorString(), ")");
    }

    // Before triangulation, which trusts them.
    void check_source_indices() const {
        for (unsigned i = 0; i < source_->mNumMeshes; ++i) {
            const aiMesh& mesh = *source_->mMeshes[i];
            for (unsigned f = 0; f < mesh.mNumFaces; ++f)
                for (unsigned c = 0; c < mesh.mFaces[f].mNumIndices; ++c)
                    if (const unsigned index = mesh.mFaces[f].mIndices[c]; index >= mesh.mNumVertices)
                        fail("'", path_.string(), "': ", mesh_name(i), " face ", f, " has vertex index ", index,
                             ", but the mesh has only ", mesh.mNumVertices, " vertices");
        }
    }

    void triangulate() {
        source_ = importer_.ApplyPostProcessing(aiProcess_Triangulate);  // nothing that drops or reorders triangles
        if (!source_) fail("'", path_.string(), "': cannot be triangulated (", importer_.GetErrorString(), ")");
    }

    std::string mesh_name(unsigned index) const {
        const std::string name = source_->mMeshes[index]->mName.C_Str();
        return name.empty() ? text("mesh ", index) : name;
    }

    // Vertices of .obj and .stl come one per corner and are shared again where they are equal. A facet normal of .stl
    // would keep them apart and says nothing that its corners do not.
    void read_mesh(unsigned index) {
        const aiMesh& source = *source_->mMeshes[index];
        Mesh mesh;
        mesh.name = mesh_name(index);
        for (unsigned i = 0; i < source.mNumVertices; ++i) {
            const auto vec3_of = [](const aiVector3D& v) { return vec3(v.x, v.y, v.z); };
            mesh.positions.push_back(vec3_of(source.mVertices[i]));
            if (source.HasNormals() && format_ != "stl") mesh.normals.push_back(vec3_of(source.mNormals[i]));
            if (source.HasTextureCoords(0))  // v points up in these formats and down in glTF and in Image
                mesh.uvs.emplace_back(source.mTextureCoords[0][i].x, 1 - source.mTextureCoords[0][i].y);
        }
        std::size_t skipped = 0;
        for (unsigned i = 0; i < source.mNumFaces; ++i)
            if (const aiFace& face = source.mFaces[i]; face.mNumIndices == 3)
                mesh.triangles.emplace_back(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
            else
                ++skipped;
        mesh.materials.assign(mesh.triangles.size(), source.mMaterialIndex);
        if (skipped) warn(text("mesh '", mesh.name, "': skipped ", skipped, " points and lines"));
        if (mesh.triangles.empty()) {
            warn(text("mesh '", mesh.name, "': has ", mesh.positions.size(), " vertices but no faces"));
            return;
        }
        placed_as_[index] = static_cast<uint>(scene_.meshes.size());
        scene_.meshes.push_back(weld_equal_vertices(mesh));
    }

    void place(const aiNode& node, const aiMatrix4x4& above) {
        const aiMatrix4x4 world = above * node.mTransformation;
        const aiMatrix4x4& m = world;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            const auto mesh = placed_as_.find(node.mMeshes[i]);
            if (mesh == placed_as_.end()) continue;
            const std::string name = node.mName.length ? node.mName.C_Str() : scene_.meshes[mesh->second].name;
            scene_.instances.push_back(
                {name,
                 mesh->second,
                 {{vec4(m.a1, m.a2, m.a3, m.a4), vec4(m.b1, m.b2, m.b3, m.b4), vec4(m.c1, m.c2, m.c3, m.c4)}}});
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) place(*node.mChildren[i], world);
    }

    Material material_of(const aiMaterial& source) {
        Material material;
        aiString name;
        if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
        material.metallic = 0;
        aiColor3D color;
        if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS)
            material.base_color = {color.r, color.g, color.b, 1};
        if (source.Get(AI_MATKEY_COLOR_EMISSIVE, color) == AI_SUCCESS) material.emission = {color.r, color.g, color.b};
        float opacity = 1;
        if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 1) {
            material.base_color.w = opacity;
            material.alpha_mode = AlphaMode::blend;
        }
        material.base_color_texture = diffuse_texture(source);
        return material;
    }

    Texture diffuse_texture(const aiMaterial& source) {
        aiString file;
        aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        if (source.GetTexture(aiTextureType_DIFFUSE, 0, &file, nullptr, nullptr, nullptr, nullptr, modes) != AI_SUCCESS)
            return {};
        const auto wrap = [](aiTextureMapMode mode) {
            if (mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal) return Wrap::clamp_to_edge;
            return mode == aiTextureMapMode_Mirror ? Wrap::mirrored_repeat : Wrap::repeat;
        };
        Texture texture;
        texture.image = image_of(file.C_Str());
        texture.wrap_u = wrap(modes[0]);
        texture.wrap_v = wrap(modes[1]);
        return texture;
    }

    std::int32_t image_of(std::string name) {
        std::ranges::replace(name, '\\', '/');  // many .mtl files come from Windows
        const auto [entry, is_new] = images_.try_emplace(name, static_cast<std::int32_t>(scene_.images.size()));
        if (!is_new) return entry->second;
        try {
            scene_.images.push_back(decode_image(read_file(path_.parent_path() / name), "image '" + name + "'"));
        } catch (const Error& e) {
            warn(text(e.what(), "; it is shown as a checkerboard"));
            scene_.images.push_back(checkerboard_image(name));
        }
        return entry->second;
    }

    void warn(std::string sentence) { scene_.warnings.push_back(std::move(sentence)); }

    std::filesystem::path path_;
    std::string format_;
    Assimp::Importer importer_;
    const aiScene* source_ = nullptr;
    Scene scene_;
    std::map<unsigned, uint> placed_as_;  // Assimp's mesh -> the scene's; those without triangles are absent
    std::map<std::string, std::int32_t> images_;
};

}  // namespace

Scene import_assimp(const std::filesystem::path& file, const std::string& format) {
    return AssimpReader(file, format).read();
}

}  // namespace twinray
