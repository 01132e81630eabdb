#!/usr/bin/env bash
# Checks the public headers: each compiles alone, none needs another project but Vulkan, and a kernel of an application
# finds the GLSL.
#   tools/check_headers.sh CXX GLSLANG_VALIDATOR FOLDER     FOLDER: where twinray/twinray.h is
set -euo pipefail

if (($# != 3)); then
    echo "usage: tools/check_headers.sh CXX GLSLANG_VALIDATOR FOLDER" >&2
    exit 2
fi
cxx=$1 glslang=$2 folder=$(realpath "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The adapter goes with the application's own Vulkan Memory Allocator.
mapfile -t headers < <(cd "$folder" && find twinray -maxdepth 1 -name '*.h' ! -name vma_adapter.h | sort)
for header in "${headers[@]}"; do
    echo "#include <$header>" | "$cxx" -std=c++20 -I"$folder" -fsyntax-only -Wall -Wextra -Wconversion -Werror \
        -MD -MF "$work/$(basename "$header").d" -x c++ -
done

# Compiles structs and functions of kernels as C++, with GLM, which the application may choose.
for header in cpp cpp_spawn cpp_sampling; do
    echo "#include <twinray/glsl/$header.h>" |
        "$cxx" -std=c++20 -I"$folder" -fsyntax-only -Wall -Wextra -Werror -x c++ -
done

# Names that are not twinray's, Vulkan's, the compiler's or the C library's.
others=$(cat "$work"/*.d | grep -oE "(^| )/[^ :]+" | tr -d " " | sort -u |
    grep -vE "^$folder/|/vulkan/|/vk_video/|/c\+\+/|/lib/(gcc|llvm|clang|linux)|^/usr/include/([a-z0-9_-]+-linux-gnu/|sys/|bits/|asm[a-z-]*/|linux/|gnu/)?[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*\.h$" || true)
others+=$(cat "$work"/*.d | tr ' ' '\n' | grep -E '/(glm|nlohmann|CLI|OpenEXR|Imath|eigen3|Eigen)/|(vk_mem_alloc|volk|stb_[a-z_]*|tiny_gltf[a-z_0-9]*|zlib|gmp(xx)?)\.h' || true)
if [[ -n $others ]]; then
    printf '%s\n' "$others" >&2
    echo "check_headers: the headers above, of other projects, are reached from public ones" >&2
    exit 1
fi

cat >"$work/kernel.comp" <<'GLSL'
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
#include "twinray/glsl/spawn.glsl"
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/soa.glsl"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/sobol.h"
#include "twinray/glsl/textures.glsl"
#include "twinray/glsl/unrolled.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

void main()
{
    Hit hit;
    Ray ray = AT(args.rays, 0);
    if (!closest_hit(args.scene, ray, hit)) return;
    Placement placement = placement_of(AT(REF(InstanceRecord)(args.scene), 0));
    TriangleVertices vertices = TriangleVertices(vec3(0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
    SurfacePoint point = surface_point(placement, vertices, crossing_of(ray, placement, vertices).uv);
    ray.origin = spawn_position(point, true);
    ray.direction = sample_cosine_hemisphere(unit_floats(sobol_point(uvec4(0u), 1u).xy));
    if (!any_hit(args.scene, ray)) AT(args.hits, 0) = hit;
}
GLSL
for accel in SW HW; do
    "$glslang" --quiet -V --target-env vulkan1.2 -DTWINRAY_$accel -I"$folder" -I"$folder/twinray/glsl" \
        -o "$work/kernel.spv" "$work/kernel.comp"
done
echo "check_headers: ${#headers[@]} headers, each alone, and a kernel need nothing but Vulkan"
