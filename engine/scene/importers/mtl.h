// Lines of .obj and .mtl files, and the materials of the latter.
#pragma once

#include <twinray/scene.h>

#include "engine/core/interruption.h"
#include "engine/scene/importers/words.h"

namespace twinray {

// The lines with contents, one after the other. A backslash at the end of a line joins the next one to it, unless a
// comment has begun.
class ObjLines {
  public:
    explicit ObjLines(std::string_view text) : rest_(text) {}

    bool next();  // false at the end
    std::string_view keyword() const { return keyword_; }
    // Returns the text after the keyword, without a comment, which # begins anywhere. In a name it has to stand alone,
    // since there are materials called "Material #25".
    std::string_view numbers() const;
    std::string_view name() const;
    std::size_t line() const { return line_; }  // number of its first line, from 1

  private:
    std::string_view cut_joined_line();

    std::string_view rest_, keyword_, value_;
    std::string joined_;
    std::size_t line_ = 0, lines_cut_ = 0;
    LoopInterruption interruption_;
};

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
