// SPDX-License-Identifier: MIT
// Solutions of the exercises of tutorial 2. Exits with 1 unless each gives the known result; writes a picture of all
// three together.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "tracer.h"

namespace {

// [glass]
// Rays that hit the ball in the middle pass through it, as if it were glass, and continue where they leave it.
void pass_through_glass(AbstractAccel& accel, std::vector<Ray>& rays) {
    const float index = 1.5f;
    for (int crossing = 0; crossing < 2; ++crossing) {  // into the ball, out of the ball
        const std::vector<Surface> surfaces = accel.surfaces(rays, accel.closest_hits(rays));
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!surfaces[i].is_hit || surfaces[i].custom_index != 2) continue;
            const vec3 direction = normalize(rays[i].direction);
            const bool enters = dot(direction, surfaces[i].point.normal) < 0;
            const float ratio = enters ? 1 / index : index;
            const vec3 normal = enters ? surfaces[i].normal : -surfaces[i].normal;
            // Snell: the part along the surface is scaled by the ratio; the rest of length 1 goes through it.
            const vec3 along = (direction - normal * dot(direction, normal)) * ratio;
            const float through = 1 - dot(along, along);
            const vec3 refracted = along - normal * std::sqrt(std::max(0.0f, through));
            rays[i] = leave(surfaces[i], through > 0 ? refracted : reflect(direction, normal));
        }
    }
}

// [light]
enum class Middle { mirror, glass };

// The loop of the tutorial: returns the light of one ray per pixel.
std::vector<vec3> light_of(AbstractAccel& accel, std::vector<Ray> rays, vec3 to_sun, Middle middle) {
    std::vector<vec3> picture(rays.size(), vec3(0));
    std::vector<Path> paths = paths_of(rays);
    for (int depth = 0; depth < 4 && !rays.empty(); ++depth) {
        if (middle == Middle::glass) pass_through_glass(accel, rays);
        bounce(accel, to_sun, rays, paths, picture);
    }
    return picture;
}

// [several]
// Returns the mean of side x side pictures, each with rays through another place of the pixels.
std::vector<vec3> several_rays(AbstractAccel& accel, uint width, uint height, uint side) {
    std::vector<vec3> mean(width * height, vec3(0));
    for (uint i = 0; i < side * side; ++i) {
        const vec2 in_pixel((float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side));
        const std::vector<vec3> picture = light_of(accel, camera_rays(width, height, in_pixel), sun, Middle::mirror);
        for (std::size_t pixel = 0; pixel < mean.size(); ++pixel) mean[pixel] += picture[pixel] / float(side * side);
    }
    return mean;
}
// [/several]

double rms_difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i] - b[i], a[i] - b[i]) / 3;
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// [sun]
// Point i of n on a sun of some size: they lie on a spiral, as seeds do in a sunflower, so that each has the same area.
vec3 point_of_sun(uint i, uint n) {
    const float radius = 0.08f;  // as seen from a distance of 1; the real sun's is 17 times smaller
    const vec3 right = normalize(cross(sun, vec3(0, 1, 0))), up = cross(right, sun);
    const float from_middle = radius * std::sqrt((float(i) + 0.5f) / float(n)), turn = 2.399963f * float(i);
    return normalize(sun + from_middle * (std::cos(turn) * right + std::sin(turn) * up));
}

// [hidden]
// Returns the fraction of the sun that the red ball hides from a place on the floor, where the ray to the middle of the
// sun passes the middle of the ball at `distance`.
double hidden_part(AbstractAccel& accel, float distance) {
    const vec3 ball(-2.1f, 1, 0), aside = normalize(cross(sun, vec3(0, 1, 0)));
    const vec3 place = ball - sun * (ball.y / sun.y) + aside * distance;
    std::vector<Ray> rays;
    const uint n = 1000;
    for (uint i = 0; i < n; ++i) rays.push_back({place, 0.125f, point_of_sun(i, n), INFINITY});
    double hidden = 0;
    for (const Hit& hit : accel.any_hits(rays, {.occlusion_only = true})) hidden += hit.hit;
    return hidden / n;
}

// [focus]
// Returns the distance from the middle of the glass ball at which rays along its axis cross it behind the ball. A ball
// of radius R whose refractive index is n has its focus at n R / (2 (n - 1)) (for rays near the axis).
double focus_of_glass(AbstractAccel& accel) {
    const vec3 ball(0, 1, -0.6f);
    std::vector<Ray> rays;
    for (uint i = 0; i < 64; ++i) {
        const float turn = 6.2831853f * float(i) / 64, off_axis = 0.0625f;
        const vec3 origin = ball + vec3(off_axis * std::cos(turn), off_axis * std::sin(turn), 3);
        rays.push_back({origin, 0, vec3(0, 0, -1), INFINITY});
    }
    pass_through_glass(accel, rays);
    double sum = 0;
    for (const Ray& ray : rays) {
        const vec2 from_axis(ray.origin.x - ball.x, ray.origin.y - ball.y), slope(ray.direction.x, ray.direction.y);
        const float t = -dot(from_axis, slope) / dot(slope, slope);
        sum += ball.z - (ray.origin.z + t * ray.direction.z);
    }
    return sum / static_cast<double>(rays.size());
}

// [picture]
// All three: pass i has its place in the pixels and its point of the sun.
std::vector<vec3> picture_of_all(AbstractAccel& accel, uint width, uint height) {
    std::vector<vec3> mean(width * height, vec3(0));
    const uint side = 4, n = side * side;
    for (uint i = 0; i < n; ++i) {
        const uint j = 7 * i % n;  // neighbours in the pixel get points of the sun that are far apart
        const vec2 in_pixel((float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side);
        const std::vector<vec3> picture =
            light_of(accel, camera_rays(width, height, in_pixel), point_of_sun(j, n), Middle::glass);
        for (std::size_t pixel = 0; pixel < mean.size(); ++pixel) mean[pixel] += picture[pixel] / float(n);
    }
    return mean;
}
// [/picture]

}  // namespace

int main(int argc, char** argv) try {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    Context context;
    SwTlas accel(context, {.keeps_surfaces = true});
    push_balls(accel);

    const std::vector<vec3> converged = several_rays(accel, 120, 90, 8);
    std::vector<double> errors;
    for (const uint side : {1u, 2u, 4u}) {
        errors.push_back(rms_difference(several_rays(accel, 120, 90, side), converged));
        std::cout << "1: " << side * side << " rays a pixel: RMS error " << errors.back() << '\n';
    }
    const std::array hidden = {hidden_part(accel, 0.75f), hidden_part(accel, 1), hidden_part(accel, 1.25f)};
    std::cout << "2: hidden within the shadow " << hidden[0] << ", at its edge " << hidden[1] << ", outside "
              << hidden[2] << '\n';
    const double focus = focus_of_glass(accel);
    std::cout << "3: the glass ball has its focus at " << focus << ", by the formula 1.5\n";

    const uint width = 400, height = 300;
    write_picture(folder / "02_ray_tracer_solutions.png", width, height, picture_of_all(accel, width, height));
    const bool is_smoother = errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1];
    const bool is_soft = hidden[0] == 1 && hidden[2] == 0 && std::abs(hidden[1] - 0.5) < 0.125;
    if (!is_smoother || !is_soft || std::abs(focus / 1.5 - 1) > 0.02) return 1;
    std::cout << "the solutions hold\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
