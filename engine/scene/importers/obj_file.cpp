// SPDX-License-Identifier: MIT
#include "engine/scene/importers/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "engine/core/error.h"
#include "engine/scene/mesh.h"
#include "engine/scene/importers/obj_lines.h"
#include "engine/scene/importers/passed_over.h"
#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

// Names in the order of their first use.
class Names {
  public:
    // The name's number, and whether it is new.
    std::pair<uint, bool> number_of(const std::string& name) {
        const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<uint>(numbers_.size()));
        return {entry->second, is_new};
    }

  private:
    std::map<std::string, uint> numbers_;
};

class ObjParser {
  public:
    ObjParser(std::string_view text, std::string object) : lines_(text), object_(std::move(object)) {}

    ObjFile parse() {
        while (lines_.next()) read_line();
        check_corners();
        warn();
        return std::move(file_);
    }

  private:
    void read_line() {
        const std::string_view keyword = lines_.keyword();
        if (keyword == "v")
            read_position();
        else if (keyword == "vt")
            read_uv();
        else if (keyword == "vn")
            read_normal();
        else if (keyword == "f" || keyword == "fo")  // fo: the same, in files from before 1993
            read_face();
        else if (keyword == "usemtl")
            use_material();
        else if (keyword == "o" || keyword == "g")
            (keyword == "o" ? object_name_ : group_name_) = lines_.name(), part_ = ObjFile::none;
        else if (keyword == "mtllib")
            add_library(std::string(lines_.name()));
        else if (keyword == "p" || keyword == "l")
            ++points_and_lines_;
        else if (keyword != "s")  // smoothing by groups, without normals
            passed_over_.add(keyword, lines_.line());
    }

    template <class... Parts>
    [[noreturn]] void fail_here(const Parts&... parts) const {
        fail("'", object_, "', line ", lines_.line(), ": ", parts...);
    }

    struct Numbers {
        std::array<double, 8> values{};
        std::size_t count = 0;
    };

    // What is behind the eighth is left alone.
    Numbers read_numbers(std::size_t least) const {
        Numbers numbers;
        std::string_view rest = lines_.numbers();
        for (std::string_view word = cut_word(rest); !word.empty() && numbers.count < 8; word = cut_word(rest)) {
            const std::optional<double> number = parse_number(word);
            if (!number) fail_here("'", word.substr(0, 20), "' is not a number");
            numbers.values[numbers.count++] = *number;
        }
        if (numbers.count < least)
            fail_here("'", lines_.keyword(), "' has ", numbers.count, " numbers; it needs ", least);
        return numbers;
    }

    void read_position() {
        const auto [v, count] = read_numbers(3);
        file_.positions.emplace_back(v[0], v[1], v[2]);
        has_colors_ |= count >= 6;
        has_weights_ |= count == 4 && v[3] != 1;
    }

    void read_uv() {
        const auto [v, count] = read_numbers(1);
        file_.uvs.emplace_back(v[0], v[1]);
    }

    void read_normal() {
        const auto [v, count] = read_numbers(3);
        file_.normals.push_back(normal_or_none({v[0], v[1], v[2]}));
    }

    void add_library(std::string names) {  // some files say it with every object
        if (std::ranges::find(file_.libraries, names) == file_.libraries.end())
            file_.libraries.push_back(std::move(names));
    }

    void use_material() {
        const std::string name(lines_.name());
        material_ = ObjFile::none;
        if (name.empty()) return;
        const auto [number, is_new] = material_names_.number_of(name);
        if (is_new) file_.materials.push_back({name, lines_.line()});
        material_ = number;
    }

    // An object is one mesh, whatever its groups and materials are.
    void use_part() {
        const std::string& name = object_name_.empty() ? group_name_ : object_name_;
        const auto [number, is_new] = part_names_.number_of(name);
        if (is_new) file_.part_names.push_back(name);
        part_ = number;
    }

    void read_face() {
        if (part_ == ObjFile::none) use_part();
        const std::size_t first = file_.face_vertices.size();
        std::string_view rest = lines_.numbers();
        for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest))
            file_.face_vertices.push_back(vertex_of(word));
        file_.faces.push_back({lines_.line(), first, file_.face_vertices.size() - first, part_, material_});
    }

    // "5", "5/2", "5//3", "5/2/3"; and "5/", "5//", "5/2/", which some programs write.
    ObjFile::FaceVertex vertex_of(std::string_view word) const {
        const std::string_view whole = word;
        ObjFile::FaceVertex vertex{.position = cut_index(word, file_.positions.size(), whole)};
        if (vertex.position == ObjFile::none) fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        vertex.uv = cut_index(word, file_.uvs.size(), whole);
        vertex.normal = cut_index(word, file_.normals.size(), whole);
        if (!word.empty()) fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        return vertex;
    }

    // Up to the next slash. From 1 on, or counted back from the last of those that are there; none if it is left out.
    uint cut_index(std::string_view& word, std::size_t count, std::string_view whole) const {
        if (word.empty() || word.front() == '/') {
            word.remove_prefix(word.empty() ? 0 : 1);
            return ObjFile::none;
        }
        std::int64_t index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        word.remove_prefix(static_cast<std::size_t>(end - word.data()));
        if (error != std::errc{} || (!word.empty() && word.front() != '/'))
            fail_here("'", whole.substr(0, 40), "' is not a vertex of a face");
        word.remove_prefix(word.empty() ? 0 : 1);
        const std::int64_t from_zero = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
        if (index == 0 || from_zero < 0 || from_zero >= std::int64_t{ObjFile::none})
            fail_here("'", whole.substr(0, 40), "' has index ", index, ", but there are ", count, " so far");
        return static_cast<uint>(from_zero);
    }

    // At the end, since faces may come before what they use.
    void check_corners() {
        for (const ObjFile::Face& face : file_.faces)
            for (std::size_t i = 0; i < face.vertex_count; ++i) {
                ObjFile::FaceVertex& vertex = file_.face_vertices[face.first_vertex + i];
                if (vertex.position >= file_.positions.size())
                    fail("'", object_, "', line ", face.line, ": vertex index ", std::uint64_t(vertex.position) + 1,
                         " is out of range; there are ", file_.positions.size(), " vertices");
                forget_missing(vertex.uv, file_.uvs.size(), "texture coordinates", face.line);
                forget_missing(vertex.normal, file_.normals.size(), "normals", face.line);
            }
    }

    void forget_missing(uint& index, std::size_t count, const char* what, std::size_t line) {
        if (index == ObjFile::none || index < count) return;
        index = ObjFile::none;
        missing_.add(what, line);
    }

    void warn() {
        const auto warn_if = [&](bool is_so, const std::string& sentence) {
            if (is_so) file_.warnings.push_back(sentence);
        };
        warn_if(points_and_lines_ > 0, text("skipped ", points_and_lines_, " points and lines"));
        warn_if(has_colors_, "vertex colours are ignored");
        warn_if(has_weights_, "weights of vertices (the fourth number of 'v') are ignored");
        warn_if(!missing_.empty(), text("faces use what the file does not have: ", missing_.list()));
        warn_if(!passed_over_.empty(), text("passed over lines that begin with ", passed_over_.list()));
    }

    ObjLines lines_;
    std::string object_;
    ObjFile file_;
    Names part_names_, material_names_;
    std::string object_name_, group_name_;
    uint part_ = ObjFile::none, material_ = ObjFile::none;
    std::size_t points_and_lines_ = 0;
    bool has_colors_ = false, has_weights_ = false;
    PassedOver missing_, passed_over_;
};

}  // namespace

ObjFile parse_obj(std::string_view text, const std::string& object) { return ObjParser(text, object).parse(); }

}  // namespace twinray
