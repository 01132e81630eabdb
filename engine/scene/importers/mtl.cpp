#include "engine/scene/importers/mtl.h"

#include <algorithm>

#include "engine/core/platform.h"
#include "engine/core/error.h"
#include "engine/scene/images.h"

namespace twinray {
namespace {

// Returns whether the word changes nothing here: other lighting models, and words that every file has.
bool is_of_no_use(std::string_view keyword) {
    constexpr std::array<std::string_view, 7> words = {"Ka", "Ks", "Ns", "Ni", "Tf", "illum", "sharpness"};
    return std::ranges::find(words, keyword) != words.end();
}

// Replaces backslashes: many files come from Windows.
std::string with_slashes(std::string_view path) {
    std::string changed(path);
    std::ranges::replace(changed, '\\', '/');
    return changed;
}

// Cuts off up to `most` numbers that are followed by something.
std::array<float, 3> cut_numbers(std::string_view& rest, std::size_t most, float otherwise) {
    std::array<float, 3> numbers = {otherwise, otherwise, otherwise};
    for (std::size_t i = 0; i < most; ++i) {
        std::string_view after = rest;
        const std::optional<double> number = parse_number(cut_word(after));
        if (!number || trimmed(after).empty()) break;
        numbers[i] = static_cast<float>(*number);
        rest = after;
    }
    return numbers;
}

// Cuts the options off that a texture's name begins with. Texture coordinates are v upwards in the file, downwards
// here.
Texture cut_texture_options(std::string_view& rest, std::size_t line, PassedOver& passed_over) {
    Texture texture;
    vec2 scale(1), offset(0);
    for (;;) {
        std::string_view after = rest;
        const std::string_view option = cut_word(after);
        if (option == "-s" || option == "-o") {
            const std::array<float, 3> uvw = cut_numbers(after, 3, option == "-s" ? 1 : 0);
            (option == "-s" ? scale : offset) = vec2(uvw[0], uvw[1]);
        } else if (option == "-clamp") {
            if (cut_word(after) == "on") texture.wrap_u = texture.wrap_v = Wrap::clamp_to_edge;
        } else if (option == "-t" || option == "-mm") {
            cut_numbers(after, 3, 0);
            passed_over.add(option, line);
        } else if (option.size() > 1 && option.starts_with('-') && !trimmed(after).empty()) {
            cut_word(after);
            passed_over.add(option, line);
        } else {
            break;
        }
        rest = after;
    }
    texture.uv_row0 = {scale.x, 0, offset.x};
    texture.uv_row1 = {0, scale.y, 1 - scale.y - offset.y};
    return texture;
}

// Returns where a comment begins: at a #, unless the # is in a number of Microsoft's C library.
std::size_t comment_begin(std::string_view line) {
    const auto is_in_number = [&](std::size_t at) {
        const std::string_view after = line.substr(at + 1);
        return at > 0 && line[at - 1] == '.' &&
               (after.starts_with("IN") || after.starts_with("QNAN") || after.starts_with("SNAN"));
    };
    std::size_t at = line.find('#');
    while (at != line.npos && is_in_number(at)) at = line.find('#', at + 1);
    return std::min(at, line.size());
}

}  // namespace

Material plain_material(std::string name) {
    return {.name = std::move(name), .base_color = vec4(0.6f, 0.6f, 0.6f, 1), .metallic = 0};
}

void MtlReader::read_files(std::string_view names) {
    const std::string lower = lowered(names);
    for (std::size_t first = 0; first < names.size();) {
        const std::size_t found = lower.find(".mtl ", first);
        const std::size_t end = found == lower.npos ? names.size() : found + 4;
        const std::string_view name = trimmed(names.substr(first, end - first));
        first = end;
        if (name.empty()) continue;
        file_ = obj_folder_ / with_slashes(name);
        try {
            const Bytes bytes = read_file(file_);
            read_lines(text_of(bytes, file_.string()));
        } catch (const Error& e) {
            scene_.warnings.push_back(text(e.what(), "; its materials are missing"));
        }
    }
}

uint MtlReader::index_of(const std::string& name, std::size_t line) {
    const auto [entry, is_new] = indices_.try_emplace(name, static_cast<uint>(scene_.materials.size()));
    if (is_new) {
        scene_.materials.push_back(plain_material(name));
        missing_.add(name, line);
    }
    return entry->second;
}

void MtlReader::warn_of_missing() {
    if (!missing_.empty())
        scene_.warnings.push_back(text("materials that no .mtl file of it has are shown grey: ", missing_.list()));
}

void MtlReader::read_lines(std::string_view text_of_file) {
    current_.reset();
    passed_over_ = {};
    for (ObjLines lines(text_of_file); lines.next();) read_line(lines);
    if (!passed_over_.empty())
        scene_.warnings.push_back(text("'", file_.string(), "': passed over ", passed_over_.list()));
}

void MtlReader::read_line(const ObjLines& line) {
    const std::string_view keyword = line.keyword();
    if (keyword == "newmtl")
        start(line.name());
    else if (!current_)
        passed_over_.add(keyword, line.line());
    else if (keyword == "Kd" || keyword == "Ke")
        read_color(line);
    else if (keyword == "d" || keyword == "Tr")
        read_opacity(line);
    else if (keyword == "map_Kd")
        read_texture(line);
    else if (!is_of_no_use(keyword))
        passed_over_.add(keyword, line.line());
}

// Starts a material; one that exists already is defined anew.
void MtlReader::start(std::string_view name) {
    const auto [entry, is_new] = indices_.try_emplace(std::string(name), static_cast<uint>(scene_.materials.size()));
    current_ = Current{.index = entry->second};
    if (is_new) scene_.materials.emplace_back();
    scene_.materials[entry->second] = plain_material(entry->first);
}

void MtlReader::read_color(const ObjLines& line) {
    std::vector<float> numbers;
    std::string_view rest = line.numbers();
    for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest)) {
        const std::optional<double> number = parse_number(word);
        if (!number || !std::isfinite(*number))
            return passed_over_.add(text(line.keyword(), ' ', word),
                                    line.line());  // "Kd spectral file", "Kd xyz 1 1 1"
        numbers.push_back(static_cast<float>(*number));
    }
    if (numbers.empty()) return passed_over_.add(line.keyword(), line.line());
    numbers.resize(3, numbers.front());
    Material& material = scene_.materials[current_->index];
    const vec3 color(numbers[0], numbers[1], numbers[2]);
    if (line.keyword() == "Ke") {
        material.emission = color;
        return;
    }
    material.base_color = vec4(color, material.base_color.w);
    current_->has_color = true;
}

// Tr is 1 - d. If a file has both, d counts: some programs write them equal.
void MtlReader::read_opacity(const ObjLines& line) {
    std::string_view rest = line.numbers();
    std::string_view word = cut_word(rest);
    if (word == "-halo") word = cut_word(rest);
    const std::optional<double> number = parse_number(word);
    if (!number || std::isnan(*number)) return passed_over_.add(text(line.keyword(), ' ', word), line.line());
    const bool is_tr = line.keyword() == "Tr";
    if (is_tr && current_->has_opacity) return;
    current_->has_opacity |= !is_tr;
    Material& material = scene_.materials[current_->index];
    material.base_color.w = static_cast<float>(std::clamp(is_tr ? 1 - *number : *number, 0.0, 1.0));
    material.alpha_mode = material.base_color.w < 1 ? AlphaMode::blend : AlphaMode::opaque;
}

void MtlReader::read_texture(const ObjLines& line) {
    std::string_view name = line.name();
    Texture texture = cut_texture_options(name, line.line(), passed_over_);
    name = trimmed(name);
    if (name.empty()) return passed_over_.add(line.keyword(), line.line());
    texture.image = image_of(name);
    Material& material = scene_.materials[current_->index];
    material.base_color_texture = texture;
    if (!current_->has_color) material.base_color = vec4(1, 1, 1, material.base_color.w);
}

std::int32_t MtlReader::image_of(std::string_view name) {
    const std::filesystem::path file = find(name);
    const auto [entry, is_new] = images_.try_emplace(file, static_cast<std::int32_t>(scene_.images.size()));
    if (!is_new) return entry->second;
    try {
        scene_.images.push_back(decode_image(read_file(file), text("image '", name, "'")));
    } catch (const Error& e) {
        scene_.warnings.push_back(text(e.what(), "; it is shown as a checkerboard"));
        scene_.images.push_back(checkerboard_image(std::string(name)));
    }
    return entry->second;
}

// Looks relative to the .mtl file, then to the .obj file.
std::filesystem::path MtlReader::find(std::string_view name) const {
    std::error_code ignored;
    const std::filesystem::path named = platform::path_of(with_slashes(name)), beside = file_.parent_path() / named;
    return std::filesystem::exists(beside, ignored) ? beside : obj_folder_ / named;
}

bool ObjLines::next() {
    while (!rest_.empty()) {
        interruption_.look();
        line_ = lines_cut_ + 1;
        value_ = cut_joined_line();
        keyword_ = cut_word(value_);
        if (!keyword_.empty() && !keyword_.starts_with('#')) return true;
    }
    return false;
}

std::string_view ObjLines::cut_joined_line() {
    const auto cut = [&] {
        ++lines_cut_;
        return trimmed(cut_line(rest_));
    };
    const auto goes_on = [](std::string_view line) {
        return line.ends_with('\\') && comment_begin(line) == line.size();
    };
    std::string_view line = cut();
    if (!goes_on(line)) return line;
    for (joined_.clear(); goes_on(line); line = cut()) {
        joined_ += line.substr(0, line.size() - 1);
        joined_ += ' ';
    }
    joined_ += line;
    return joined_;
}

std::string_view ObjLines::numbers() const { return value_.substr(0, comment_begin(value_)); }

std::string_view ObjLines::name() const {
    std::string_view rest = value_;
    for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest))
        if (word == "#") return trimmed({value_.begin(), word.begin()});
    return trimmed(value_);
}

}  // namespace twinray
