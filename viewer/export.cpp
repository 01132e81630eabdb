// SPDX-License-Identifier: MIT
#include "viewer/export.h"

#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/scene/glb.h"

namespace twinray::viewer {
namespace {

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

void write_values(const std::filesystem::path& file, const Scene& scene, const Values& values) {
    if (values.numbers.size() != count_triangles(scene))
        fail("'", file.string(), "': only the layers light, factors and collisions have values of faces to write");
    if (file.extension() == ".csv") return write_csv(file, scene, values);
    std::vector<Rgb> colors;
    for (const double number : values.numbers) colors.push_back(values.color(number));
    write_glb(file, scene, colors);
}

}  // namespace twinray::viewer
