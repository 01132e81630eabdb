#include "viewer/files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/scene/glb.h"

namespace twinray::viewer {
namespace {

constexpr std::size_t most_files = 8;

void write_csv(const std::filesystem::path& file, const Scene& scene, const Values& values) {
    std::ofstream out(file);
    out.precision(9);
    out << "instance,triangle,value\n";
    std::size_t face = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        for (std::size_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); ++t, ++face)
            if (!std::isnan(values.numbers[face])) out << i << ',' << t << ',' << values.numbers[face] << '\n';
    out.close();
    if (!out) fail("'", file.string(), "': cannot be written");
}

}  // namespace

std::filesystem::path recent_list() {
    const std::filesystem::path folder = platform::state_folder();
    return folder.empty() ? folder : folder / "recent";
}

std::vector<std::filesystem::path> recent_files(const std::filesystem::path& list) {
    std::ifstream in(list);
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (std::string line; files.size() < most_files && std::getline(in, line);)
        if (const std::filesystem::path file = platform::path_of(line); std::filesystem::is_regular_file(file, none))
            files.push_back(file);
    return files;
}

void keep_recent(const std::filesystem::path& list, const std::filesystem::path& file) {
    if (list.empty()) return;
    std::error_code none;
    const std::filesystem::path shown = std::filesystem::absolute(file, none);
    std::vector<std::filesystem::path> files = recent_files(list);
    std::erase(files, shown);
    files.insert(files.begin(), shown);
    files.resize(std::min(files.size(), most_files));
    std::filesystem::create_directories(list.parent_path(), none);
    std::ofstream out(list);
    for (const std::filesystem::path& each : files) out << each.string() << '\n';
}

void write_values(const std::filesystem::path& file, const Scene& scene, const Values& values) {
    if (values.numbers.size() != count_triangles(scene))
        fail("'", file.string(), "': only the layers light, factors and collisions have values of faces to write");
    if (file.extension() == ".csv") return write_csv(file, scene, values);
    std::vector<Rgb> colors;
    for (const double number : values.numbers) colors.push_back(values.color(number));
    write_glb(file, scene, colors);
}

}  // namespace twinray::viewer
