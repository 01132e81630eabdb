#include "renderer/configuration.h"

#include <cstdio>
#include <iomanip>

#include "renderer/surface_records.h"
#include "samples/support/files.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::crc32_of;
using samples::fail;
using samples::text;
namespace {

constexpr const char* environment_entry = "environment";
constexpr const char *picture_entry = "picture", *part_entry = "part";
constexpr const char* default_sky_value = "default sky";

// The sum of many values, one after the other.
class Sum {
  public:
    template <class Values>
    Sum& add(const Values& values) {
        sum_ = crc32_of(std::as_bytes(std::span(values)), sum_);
        return *this;
    }
    std::string hex() const { return text(std::hex, std::setw(8), std::setfill('0'), sum_); }

  private:
    uint sum_ = 0;
};

std::string geometry_sum(const Scene& scene) {
    Sum sum;
    for (const Mesh& mesh : scene.meshes)
        sum.add(mesh.positions)
            .add(unit_normals(mesh))
            .add(unit_tangents(mesh))
            .add(mesh.uvs)
            .add(mesh.second_uvs)
            .add(mesh.colors)
            .add(mesh.triangles)
            .add(mesh.materials);
    std::vector<SurfaceInstance> instances;
    std::vector<uint> meshes, overrides;
    for (const Instance& instance : scene.instances) {
        instances.push_back(instance_record(instance.transform));
        meshes.push_back(instance.mesh);
        if (instance.material)
            overrides.insert(overrides.end(), {static_cast<uint>(meshes.size()), *instance.material});
    }
    return sum.add(instances).add(meshes).add(overrides).hex();
}

std::string image_sum(const Scene& scene, const TextureList& list) {
    Sum sum;
    std::vector<uint> sampled;
    for (const auto& [image, options] : list.textures)
        sampled.insert(sampled.end(), {image, static_cast<uint>(options.wrap_u), static_cast<uint>(options.wrap_v),
                                       static_cast<uint>(options.is_srgb), static_cast<uint>(options.filter)});
    sum.add(sampled);
    for (const Image& image : scene.images)
        sum.add(std::vector<uint>{image.width, image.height}).add(image.rgba).add(image.rgba16);
    return sum.hex();
}

std::string environment_text(const EnvironmentMap* environment, bool is_default_sky) {
    if (is_default_sky) return default_sky_value;
    if (!environment) return "none";
    const HdrImage& image = environment->image;
    return text(image.width, " x ", image.height, ' ', Sum().add(image.rgb).hex());
}

const char* filter_text(uint filter) {
    return filter == FILTER_BOX ? "box" : filter == FILTER_TRIANGLE ? "triangle" : "gaussian";
}

const char* strategy_text(uint strategy) {
    return strategy == STRATEGY_MIS ? "lights and surfaces" : strategy == STRATEGY_LIGHTS ? "lights" : "surfaces";
}

}  // namespace

Configuration configuration_of(const RenderSettings& settings, const Scene& scene, const LocalLights& lights,
                               const EnvironmentMap* environment, bool is_default_sky) {
    const Crop part = settings.part();
    TextureList textures;
    const std::string materials =
        Sum().add(material_records(scene, textures)).add(layered_records(scene, textures)).hex();
    const std::string sampling = settings.block_size > 1
                                     ? text("blocks of ", settings.block_size, " that do not depend on each other")
                                     : "one sequence a pixel";
    return {{picture_entry, text(settings.width, " x ", settings.height)},
            {part_entry, text(part.width, " x ", part.height, " at ", part.x, ", ", part.y)},
            {"sampling", sampling},
            {"filter", filter_text(settings.filter)},
            {"seed", text(settings.seed)},
            {"max depth", text(settings.max_depth)},
            {"direct light by sampling", strategy_text(settings.strategy)},
            {"camera", Sum().add(std::vector{settings.camera}).hex()},
            {"geometry", geometry_sum(scene)},
            {"materials", materials},
            {"images", image_sum(scene, textures)},
            {"lights", Sum().add(lights.punctual).add(lights.table).hex()},
            {environment_entry, environment_text(environment, is_default_sky)}};
}

float exposure_of(const std::optional<float>& wanted, const Configuration& configuration, const HdrImage& picture) {
    if (wanted) return *wanted;
    return value_of(configuration, environment_entry) == default_sky_value ? 0 : automatic_exposure(picture);
}

HdrImage::Part part_of(const Configuration& configuration) {
    HdrImage::Part part;
    uint width = 0, height = 0;
    const std::string whole = value_of(configuration, picture_entry), part_text = value_of(configuration, part_entry);
    if (std::sscanf(whole.c_str(), "%u x %u", &part.whole_width, &part.whole_height) != 2 ||
        std::sscanf(part_text.c_str(), "%u x %u at %u, %u", &width, &height, &part.x, &part.y) != 4)
        fail("a film's configuration says '", whole, "' and '", part_text, "': not where its pixels lie");
    return part;
}

void write_picture_of(const std::filesystem::path& file, const Configuration& configuration, HdrImage picture,
                      const std::optional<float>& exposure, std::span<const ImageChannel> layers) {
    picture.part = part_of(configuration);
    write_image(file, picture, exposure_of(exposure, configuration, picture), layers);
}

std::string hash_of(const Configuration& configuration) { return Sum().add(text_of(configuration)).hex(); }

}  // namespace twinray::path_tracer
