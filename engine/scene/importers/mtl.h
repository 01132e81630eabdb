// SPDX-License-Identifier: MIT
// Materials of Wavefront OBJ.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include <twinray/scene.h>

#include "engine/scene/importers/obj_lines.h"
#include "engine/scene/importers/words.h"

namespace twinray {

// Returns the material of a surface of no stated colour: grey, no metal.
Material plain_material(std::string name);

// The materials of .mtl files, put at the end of Scene::materials in the order of the files. Missing and unused parts
// are listed in Scene::warnings.
class MtlReader {
  public:
    MtlReader(Scene& scene, std::filesystem::path obj_folder) : scene_(scene), obj_folder_(std::move(obj_folder)) {}

    // Reads the value of `mtllib`: one file's name, which may have blanks in it, or several that each end in .mtl.
    void read_files(std::string_view names);

    // Returns the material's index. One that no file has is plain, and warn_of_missing() says so; `line` is that of its
    // use.
    uint index_of(const std::string& name, std::size_t line);
    void warn_of_missing();

  private:
    struct Current {
        uint index;
        bool has_color = false, has_opacity = false;
    };

    void read_lines(std::string_view text);
    void read_line(const ObjLines& line);
    void start(std::string_view name);
    void read_color(const ObjLines& line);
    void read_opacity(const ObjLines& line);
    void read_texture(const ObjLines& line);
    std::int32_t image_of(std::string_view name);
    std::filesystem::path find(std::string_view name) const;

    Scene& scene_;
    std::filesystem::path obj_folder_, file_;
    std::map<std::string, uint> indices_;
    std::map<std::filesystem::path, std::int32_t> images_;
    std::optional<Current> current_;
    PassedOver passed_over_, missing_;
};

}  // namespace twinray
