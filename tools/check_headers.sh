#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks an installed folder of headers: that each finds what it includes, that none needs more of other libraries than
# Vulkan and GLM, and that a kernel of a host finds the shared GLSL.
#   tools/check_headers.sh CXX GLSLANG_VALIDATOR FOLDER
set -euo pipefail

if (($# != 3)); then
    echo "usage: tools/check_headers.sh CXX GLSLANG_VALIDATOR FOLDER" >&2
    exit 2
fi
cxx=$1 glslang=$2 folder=$(realpath "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The bridge's two halves and what stands between them are parts of other headers; the adapter goes with the host's
# own Vulkan Memory Allocator.
mapfile -t headers < <(cd "$folder" && find engine swtlas hwtlas -name '*.h' ! -name 'bridge_*.h' ! -name vma_adapter.h | sort)
printf '#include "%s"\n' "${headers[@]}" >"$work/all.cpp"
"$cxx" -std=c++20 -I"$folder" -I"$folder/.." -fsyntax-only -Wall -Wextra -Werror -MD -MF "$work/all.d" "$work/all.cpp"

private='/(vk_mem_alloc|stb_[a-z_]*|tiny_gltf[a-z_0-9]*|zlib|gmp(xx)?)\.h|/(OpenEXR|Imath|nlohmann)/'
if leaks=$(grep -oE "[^ ]*($private)[^ ]*" "$work/all.d"); then
    printf '%s\n' "$leaks"
    echo "check_headers: the private headers above are reached from public ones" >&2
    exit 1
fi

cat >"$work/kernel.comp" <<'GLSL'
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/query.glsl"
#include "twinray/spawn.glsl"
#include "twinray/multi_type_set.glsl"
#include "twinray/soa.glsl"
#include "twinray/textures.glsl"
#include "twinray/unrolled.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TraceArgs args; };

void main()
{
    Hit hit;
    Ray ray = AT(args.rays, 0);
    if (!closest_hit(args.scene, ray, hit)) return;
    Corners corners = Corners(vec3(0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
    ray.origin = spawn_position(surface_point(placement_of(AT(REF(InstanceRecord)(args.scene), 0)), corners, vec2(hit.u, hit.v)), true);
    if (!any_hit(args.scene, ray)) AT(args.hits, 0) = hit;
}
GLSL
for accel in SW HW; do
    "$glslang" --quiet -V --target-env vulkan1.2 -DTWINRAY_$accel -I"$folder" -I"$folder/.." \
        -o "$work/kernel.spv" "$work/kernel.comp"
done
echo "check_headers: ${#headers[@]} headers and a kernel need nothing private"
