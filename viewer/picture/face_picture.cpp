// SPDX-License-Identifier: MIT
#include "viewer/picture/face_picture.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "twinray/glsl/vector_math.h"

namespace twinray {
namespace {

constexpr std::size_t rays_a_batch = 1 << 20;
constexpr uint samples_of_an_edge = 8;
constexpr int visible_difference = 8;  // of 255
constexpr float light_at_least = 0.5f;

class Shader {
  public:
    Shader(const Scene& scene, std::span<const Rgb> colors)
        : scene_(scene), colors_(colors), first_faces_(first_faces(scene)) {}

    // Returns a linear colour.
    vec3 operator()(const Ray& ray, const Hit& hit) const {
        if (hit.hit == 0) return linear_of(background);
        const dvec3 normal = front_normal(scene_, hit), direction(ray.direction);
        const double size = length(normal) * length(direction);
        const auto cosine = static_cast<float>(size > 0 ? std::abs(dot(normal, direction)) / size : 1);
        return linear_of(colors_[first_faces_[hit.instance_index] + hit.primitive_index]) *
               (light_at_least + (1 - light_at_least) * cosine);
    }

  private:
    const Scene& scene_;
    std::span<const Rgb> colors_;
    std::vector<std::size_t> first_faces_;
};

// Traces rays number 0 to count and gives each with its hit to `take`, from many threads.
template <class MakeRay, class Take>
void trace_all(AbstractAccel& accel, std::size_t count, Cull cull, const MakeRay& make_ray, const Take& take) {
    std::vector<Ray> rays;
    for (std::size_t first = 0; first < count; first += rays.size()) {
        rays.resize(std::min(rays_a_batch, count - first));
        parallel_for(rays.size(), [&](std::size_t i) { rays[i] = make_ray(first + i); });
        const std::vector<Hit> hits = accel.closest_hits(rays, {.cull = cull});
        take(first, rays, hits);
    }
}

// Returns the first points of a plane of low discrepancy (Hammersley): one in each column and one in each row.
vec2 sample_point(uint index) {
    uint reversed = 0;
    for (uint bit = 1, weight = samples_of_an_edge / 2; weight > 0; bit *= 2, weight /= 2)
        if (index & bit) reversed += weight;
    return (vec2(index, reversed) + 0.5f) / static_cast<float>(samples_of_an_edge);
}

bool differ(Rgb a, Rgb b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > visible_difference;
}

std::vector<std::size_t> pixels_of_edges(const Raster& raster) {
    std::vector<std::size_t> pixels;
    for (uint y = 0; y < raster.height; ++y)
        for (uint x = 0; x < raster.width; ++x) {
            const Rgb here = raster.at(x, y);
            const bool is_edge = (x > 0 && differ(here, raster.at(x - 1, y))) ||
                                 (y > 0 && differ(here, raster.at(x, y - 1))) ||
                                 (x + 1 < raster.width && differ(here, raster.at(x + 1, y))) ||
                                 (y + 1 < raster.height && differ(here, raster.at(x, y + 1)));
            if (is_edge) pixels.push_back(std::size_t{y} * raster.width + x);
        }
    return pixels;
}

void draw_centers(AbstractAccel& accel, const Shader& shade, const FacePictureDesc& desc, FacePicture& picture) {
    const auto ray = [&](std::size_t pixel) {
        return ray_through(picture.plane, in_plane(desc.width, desc.height, pixel));
    };
    trace_all(accel, picture.raster.pixels.size(), desc.cull, ray,
              [&](std::size_t first, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
                  parallel_for(rays.size(), [&](std::size_t i) {
                      picture.raster.pixels[first + i] = rgb_of_linear(shade(rays[i], hits[i]));
                      picture.depths[first + i] = hits[i].hit ? hits[i].t : INFINITY;
                  });
              });
}

void smooth_edges(AbstractAccel& accel, const Shader& shade, const FacePictureDesc& desc, FacePicture& picture) {
    const std::vector<std::size_t> edges = pixels_of_edges(picture.raster);
    const auto ray = [&](std::size_t i) {
        const vec2 within = sample_point(static_cast<uint>(i % samples_of_an_edge));
        return ray_through(picture.plane, in_plane(desc.width, desc.height, edges[i / samples_of_an_edge], within));
    };
    static_assert(rays_a_batch % samples_of_an_edge == 0);
    trace_all(accel, edges.size() * samples_of_an_edge, desc.cull, ray,
              [&](std::size_t first, const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
                  parallel_for(rays.size() / samples_of_an_edge, [&](std::size_t pixel) {
                      vec3 sum(0);
                      for (std::size_t i = 0; i < samples_of_an_edge; ++i)
                          sum += shade(rays[pixel * samples_of_an_edge + i], hits[pixel * samples_of_an_edge + i]);
                      picture.raster.pixels[edges[first / samples_of_an_edge + pixel]] =
                          rgb_of_linear(sum / static_cast<float>(samples_of_an_edge));
                  });
              });
}

void check(const AbstractAccel& accel, const Scene& scene, std::span<const Rgb> colors) {
    if (accel.n_instances() != scene.instances.size())
        fail("picture: ", accel.name(), " has ", accel.n_instances(), " instances, the scene ", scene.instances.size());
    if (const std::size_t count = count_triangles(scene); colors.size() != count)
        fail("picture: ", colors.size(), " colours for ", count, " faces");
}

}  // namespace

std::vector<std::size_t> first_faces(const Scene& scene) {
    std::vector<std::size_t> first;
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) {
        first.push_back(count);
        count += scene.meshes[instance.mesh].triangles.size();
    }
    return first;
}

dvec3 front_normal(const Scene& scene, const Hit& hit) {
    const Instance& instance = scene.instances[hit.instance_index];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const uvec3 triangle = mesh.triangles[hit.primitive_index];
    const auto vertex = [&](uint i) { return dvec3(transform_point(instance.transform, mesh.positions[i])); };
    const dvec3 a = vertex(triangle.x), normal = cross(vertex(triangle.y) - a, vertex(triangle.z) - a);
    const double size = length(normal) * (determinant(instance.transform) < 0 ? -1 : 1);
    return size != 0 ? normal / size : dvec3(0);
}

vec2 in_plane(uint width, uint height, std::size_t pixel, vec2 within) {
    const vec2 place = vec2(pixel % width, pixel / width) + within;
    return vec2(2, -2) * place / vec2(width, height) + vec2(-1, 1);
}

FacePicture draw_faces(AbstractAccel& accel, const Scene& scene, std::span<const Rgb> colors,
                       const FacePictureDesc& desc) {
    check(accel, scene, colors);
    const float aspect = static_cast<float>(desc.width) / static_cast<float>(desc.height);
    FacePicture picture{.raster = Raster(desc.width, desc.height),
                        .depths = std::vector<float>(std::size_t{desc.width} * desc.height),
                        .plane = image_plane(desc.camera, aspect)};
    const Shader shade(scene, colors);
    draw_centers(accel, shade, desc, picture);
    smooth_edges(accel, shade, desc, picture);
    return picture;
}

}  // namespace twinray
