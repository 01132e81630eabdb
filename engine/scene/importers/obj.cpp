// SPDX-License-Identifier: MIT
// .obj files.
#include <twinray/scene.h>

#include "engine/core/error.h"
#include "engine/scene/bytes.h"
#include "engine/scene/importers/importers.h"
#include "engine/scene/importers/mtl.h"
#include "engine/scene/importers/obj_file.h"
#include "engine/scene/importers/polygon.h"
#include "engine/scene/importers/weld.h"
#include "engine/scene/importers/words.h"
#include "engine/scene/local_origin.h"

namespace twinray {
namespace {

// Turns a parsed file into a Scene.
class ObjReader {
  public:
    ObjReader(const ObjFile& file, const std::filesystem::path& path, const std::optional<dvec3>& origin)
        : file_(file), path_(path) {
        scene_.warnings = file.warnings;
        scene_.origin = origin.value_or(choose_local_origin(bounds()));
        positions_ = local_positions(file.positions, scene_.origin);
    }

    Scene read() {
        read_materials();
        read_faces();
        for (std::size_t part = 0; part < parts_.size(); ++part) add_mesh(part);
        return std::move(scene_);
    }

  private:
    // Triangles of one mesh, three vertices each.
    struct Part {
        std::vector<ObjFile::FaceVertex> vertices;
        std::vector<uint> materials;
        bool has_uvs = false, has_normals = false;
    };

    // Of the vertices that faces use.
    Bounds64 bounds() const {
        Bounds64 bounds;
        for (const ObjFile::FaceVertex& vertex : file_.face_vertices) bounds.include(file_.positions[vertex.position]);
        return bounds;
    }

    void read_materials() {
        MtlReader library(scene_, path_.parent_path());
        for (const std::string& names : file_.libraries) library.read_files(names);
        for (const auto& [name, line] : file_.materials) materials_.push_back(library.index_of(name, line));
        library.warn_of_missing();
    }

    uint material_of(const ObjFile::Face& face) {
        if (face.material != ObjFile::none) return materials_[face.material];
        if (!default_material_) {
            default_material_ = static_cast<uint>(scene_.materials.size());
            scene_.materials.push_back(plain_material("default"));
        }
        return *default_material_;
    }

    void read_faces() {
        parts_.resize(file_.part_names.size());
        FaceCutter cutter;
        std::vector<dvec3> outline;
        for (const ObjFile::Face& face : file_.faces) {
            Part& part = parts_[face.part];
            const auto vertices = std::span(file_.face_vertices).subspan(face.first_vertex, face.vertex_count);
            outline.clear();
            for (const ObjFile::FaceVertex& vertex : vertices) {
                outline.push_back(file_.positions[vertex.position]);
                part.has_uvs |= vertex.uv != ObjFile::none;
                part.has_normals |= vertex.normal != ObjFile::none;
            }
            for (const uvec3& triangle : cutter.cut(outline, face.line)) {
                part.vertices.insert(part.vertices.end(),
                                     {vertices[triangle.x], vertices[triangle.y], vertices[triangle.z]});
                part.materials.push_back(material_of(face));
            }
        }
        for (std::string& sentence : cutter.warnings("line")) scene_.warnings.push_back(std::move(sentence));
    }

    void add_mesh(std::size_t index) {
        const Part& part = parts_[index];
        if (part.materials.empty()) return;
        Mesh mesh;
        mesh.name = file_.part_names[index].empty() ? path_.stem().string() : file_.part_names[index];
        mesh.materials = part.materials;
        for (const ObjFile::FaceVertex& vertex : part.vertices) {
            mesh.positions.push_back(positions_[vertex.position]);
            if (part.has_normals)
                mesh.normals.push_back(vertex.normal == ObjFile::none ? vec3(0) : file_.normals[vertex.normal]);
            if (part.has_uvs) {
                const vec2 uv = vertex.uv == ObjFile::none ? vec2(0) : file_.uvs[vertex.uv];
                mesh.uvs.emplace_back(uv.x, 1 - uv.y);  // v points up in the file and down in glTF and in Image
            }
        }
        scene_.instances.push_back({mesh.name, static_cast<uint>(scene_.meshes.size()), {}});
        scene_.meshes.push_back(weld_unindexed(std::move(mesh)));
    }

    const ObjFile& file_;
    const std::filesystem::path& path_;
    Scene scene_;
    std::vector<vec3> positions_;  // relative to the scene's origin
    std::vector<uint> materials_;  // of the file's materials: the scene's
    std::optional<uint> default_material_;
    std::vector<Part> parts_;
};

}  // namespace

Scene import_obj(const std::filesystem::path& path, const std::optional<dvec3>& origin) {
    const Bytes bytes = read_packed_file(path);
    const ObjFile file = parse_obj(text_of(bytes, path.string()), path.string());
    return ObjReader(file, path, origin).read();
}

}  // namespace twinray
