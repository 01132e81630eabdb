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

// A point of a picture, in pixels from its upper left corner.
struct Placed {
    vec2 at;
    float depth;
};

std::optional<Placed> place(const FacePicture& picture, dvec3 position) {
    const std::optional<Projected> projected = project(picture.plane, position);
    if (!projected) return {};
    const vec2 size(picture.raster.width, picture.raster.height);
    return Placed{(projected->point * vec2(1, -1) + 1.0f) * 0.5f * size, projected->depth};
}

// Returns the size of a pixel at this depth, in world space.
float pixel_size(const FacePicture& picture, float depth) {
    const float at_one = 2 * length(picture.plane.right) / static_cast<float>(picture.raster.width);
    return picture.plane.is_orthographic ? at_one : at_one * depth;
}

// The stretch between two points, which may be one, covers the pixels that are no farther from it than the radius.
struct Stretch {
    Placed from, to;
    float radius;
    Rgb color;
    float behind;
};

// Returns the position on the stretch that is nearest to `at`, from 0 to 1.
float nearest(const Stretch& stretch, vec2 at) {
    const vec2 way = stretch.to.at - stretch.from.at;
    const float square = dot(way, way);
    return square > 0 ? std::clamp(dot(at - stretch.from.at, way) / square, 0.0f, 1.0f) : 0;
}

// Along a line in perspective the inverse of depth is linear in the picture.
float depth_at(const FacePicture& picture, const Stretch& stretch, float place) {
    const float a = stretch.from.depth, b = stretch.to.depth;
    return picture.plane.is_orthographic ? mix(a, b, place) : 1 / mix(1 / a, 1 / b, place);
}

void draw(FacePicture& picture, const Stretch& stretch) {
    const float reach = stretch.radius + 1;
    const vec2 size(picture.raster.width, picture.raster.height);
    const vec2 low = clamp(min(stretch.from.at, stretch.to.at) - reach, vec2(0), size);
    const vec2 high = clamp(max(stretch.from.at, stretch.to.at) + reach, vec2(0), size);
    for (uint y = static_cast<uint>(low.y); static_cast<float>(y) < high.y; ++y)
        for (uint x = static_cast<uint>(low.x); static_cast<float>(x) < high.x; ++x) {
            const vec2 center = vec2(x, y) + 0.5f;
            const float place = nearest(stretch, center);
            const float distance = length(center - mix(stretch.from.at, stretch.to.at, place));
            const float coverage = std::clamp(stretch.radius + 0.5f - distance, 0.0f, 1.0f);
            if (coverage == 0) continue;
            const float depth = depth_at(picture, stretch, place), thickness = 2 * std::max(stretch.radius, 1.0f);
            const float bulge = std::sqrt(std::max(thickness * thickness - distance * distance, 0.0f));
            const float front = depth - bulge * pixel_size(picture, depth);
            const bool is_seen = front <= picture.depths[std::size_t{y} * picture.raster.width + x];
            const float share = is_seen ? 1 : stretch.behind;
            if (share > 0) blend(picture.raster.at(x, y), stretch.color, coverage * share);
        }
}

constexpr int label_border = 3;

bool overlap(const Rect& a, const Rect& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// Places a label beside a point: to the right if there is room, else to the left, and off the others, above or below.
Rect label_box(const Raster& raster, const Placed& at, int text_wide, std::span<const Rect> taken) {
    constexpr int away = 8, most_steps = 16;
    const int dot = static_cast<int>(at.at.x), width = text_wide + 2 * label_border,
              height = text_height + 2 * label_border;
    const bool has_room = dot + away + width <= static_cast<int>(raster.width);
    Rect box{has_room ? dot + away : dot - away - width, static_cast<int>(at.at.y) - height / 2, width, height};
    const int level = box.y;
    for (int step = 1; step <= most_steps; ++step) {
        if (std::ranges::none_of(taken, [&](const Rect& other) { return overlap(box, other); })) break;
        box.y = level + (step % 2 ? 1 : -1) * (step + 1) / 2 * height;
    }
    return box;
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

std::optional<vec2> place_of(const FacePicture& picture, dvec3 position) {
    const std::optional<Placed> at = place(picture, position);
    return at ? std::optional(at->at) : std::nullopt;
}

void draw_dots(FacePicture& picture, std::span<const Dot> dots) {
    for (const Dot& dot : dots)
        if (const std::optional<Placed> at = place(picture, dot.position))
            draw(picture, {*at, *at, dot.radius, dot.color, dot.behind});
}

void draw_strokes(FacePicture& picture, std::span<const Stroke> strokes) {
    for (const Stroke& stroke : strokes) {
        const std::optional<Placed> from = place(picture, stroke.from), to = place(picture, stroke.to);
        if (from && to) draw(picture, {*from, *to, stroke.radius, stroke.color, stroke.behind});
    }
}

void draw_labels(FacePicture& picture, std::span<const Note> notes) {
    std::vector<Rect> taken;
    for (const Note& note : notes) {
        const std::optional<Placed> at = place(picture, note.position);
        if (!at || note.label.empty()) continue;
        const Rect box = label_box(picture.raster, *at, text_width(note.label), taken);
        taken.push_back(box);
        fill(picture.raster, box, paper);
        draw_text(picture.raster, box.x + label_border, box.y + label_border, note.label);
    }
}

}  // namespace twinray
