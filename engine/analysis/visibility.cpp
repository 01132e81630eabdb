#include <twinray/analysis.h>

#include <algorithm>
#include <cstring>

#include "analysis_visible_answers.spv.h"
#include "analysis_visible_rays.spv.h"
#include "engine/core/error.h"
#include "engine/core/kernel.h"
#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/analysis/visible.h"
#include "twinray/glsl/cpp_end.h"

namespace {

constexpr std::size_t rays_of_tile = 1 << 20;

float reach_of(const Bounds& box) {
    if (box.is_empty()) return 0;
    const vec3 most = max(abs(box.lo), abs(box.hi));
    return std::max({most.x, most.y, most.z});
}

class Tiles {
  public:
    Tiles(AbstractAccel& accel, std::span<const vec3> points, std::span<const vec3> directions,
          std::span<const vec3> normals, const VisibilityDesc& desc);

    // Answers for `count` points from `first` on, by point, then by direction.
    void find(std::size_t first, std::size_t count, std::uint8_t* answers);
    std::size_t points_of_tile() const { return rays_.bytes() / sizeof(Ray) / directions_; }

  private:
    AbstractAccel& accel_;
    std::size_t directions_;
    Kernel<VisibleArgs> make_rays_, tell_;
    Buffer points_, vectors_, normals_, rays_, hits_, answers_;
    float t_near_, t_far_, reach_;
    Pace pace_;
};

Tiles::Tiles(AbstractAccel& accel, std::span<const vec3> points, std::span<const vec3> directions,
             std::span<const vec3> normals, const VisibilityDesc& desc)
    : accel_(accel),
      directions_(directions.size()),
      make_rays_(accel.context(), {.name = "analysis_visible_rays", .spirv = analysis_visible_rays_spirv}),
      tell_(accel.context(), {.name = "analysis_visible_answers", .spirv = analysis_visible_answers_spirv}),
      points_(uploaded(accel.context(), "points", points)),
      vectors_(uploaded(accel.context(), "directions", directions)),
      normals_(uploaded(accel.context(), "normals of points", normals)),
      t_near_(desc.t_near),
      t_far_(desc.t_far),
      reach_(normals.empty() ? 0 : reach_of(accel.world_bound())),
      pace_(accel.context()) {
    const std::size_t rays =
        std::min(points.size(), std::max<std::size_t>(1, rays_of_tile / directions_)) * directions_;
    rays_ = Buffer(accel.context(), {.name = "rays of points", .bytes = rays * sizeof(Ray)});
    hits_ = Buffer(accel.context(), {.name = "hits of points", .bytes = rays * sizeof(Hit)});
    answers_ = Buffer(accel.context(), {.name = "what points see", .bytes = (rays + 3) / 4 * sizeof(uint)});
}

void Tiles::find(std::size_t first, std::size_t count, std::uint8_t* answers) {
    const auto rays = static_cast<uint>(count * directions_);
    const VisibleArgs args{.points = points_.ref<float>(),
                           .vectors = vectors_.ref<float>(),
                           .normals = normals_.bytes() ? normals_.ref<float>() : Floats{},
                           .rays = rays_.ref<Ray>(),
                           .hits = hits_.ref<Hit>(),
                           .answers = answers_.ref<uint>(),
                           .first_point = static_cast<uint>(first),
                           .ray_count = rays,
                           .vector_count = static_cast<uint>(directions_),
                           .t_near = t_near_,
                           .t_far = t_far_,
                           .reach = reach_};
    Commands commands(accel_.context(), "what points see");
    make_rays_.dispatch(commands, args, rays);
    accel_.trace(commands, accel_.view(),
                 {.rays = args.rays, .hits = args.hits, .count = rays, .query = Query::any, .occlusion_only = true},
                 pace_);
    tell_.dispatch(commands, args, (rays + 3) / 4);
    pace_.finish(commands);
    const std::vector<uint> words = download<uint>(accel_.context(), answers_, (rays + 3) / 4);
    std::memcpy(answers, words.data(), rays);
}

void check(std::span<const vec3> points, std::span<const vec3> directions, std::span<const vec3> normals,
           const VisibilityDesc& desc) {
    if (points.size() > UINT32_MAX) fail("visibility: ", points.size(), " points; at most ", UINT32_MAX);
    if (directions.size() > rays_of_tile)
        fail("visibility: ", directions.size(), " directions; at most ", rays_of_tile);
    if (!normals.empty() && normals.size() != points.size())
        fail("visibility: ", normals.size(), " normals for ", points.size(), " points");
    if (!(desc.t_near >= 0)) fail("visibility: t_near ", desc.t_near, " must not be below 0");
    if (!(desc.t_far > 0)) fail("visibility: t_far ", desc.t_far, " must be above 0");
}

}  // namespace

std::vector<std::uint8_t> visibility(AbstractAccel& accel, std::span<const vec3> points,
                                     std::span<const vec3> directions, std::span<const vec3> normals,
                                     const VisibilityDesc& desc) {
    check(points, directions, normals, desc);
    std::vector<std::uint8_t> answers(points.size() * directions.size());
    if (answers.empty()) return answers;
    accel.sync();
    Tiles tiles(accel, points, directions, normals, desc);
    for (std::size_t first = 0; first < points.size(); first += tiles.points_of_tile()) {
        const std::size_t count = std::min(tiles.points_of_tile(), points.size() - first);
        tiles.find(first, count, answers.data() + first * directions.size());
        if (desc.progress) desc.progress(count * directions.size());
    }
    return answers;
}

}  // namespace twinray
