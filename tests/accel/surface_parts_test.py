#!/usr/bin/env python3
"""Kernels that ask for a part of a surface have no code for the others: counts instructions of optimised SPIR-V.
Usage: surface_parts_test.py GLSLANG_VALIDATOR FOLDER..., the folders that includes are looked for in."""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import frozen_spirv  # noqa: E402

glslang, folders = sys.argv[1], sys.argv[2:]
KERNEL = """#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/surface.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { Address accel; REF(Ray) rays; REF(Hit) hits; Vec4s out_values; } push;
void main()
{
    uint i = gl_GlobalInvocationID.x;
    Hit hit = AT(push.hits, i);
    Ray ray = AT(push.rays, i);
    vec4 value = vec4(0.0);
    %s
    AT(push.out_values, i) = value;
}
"""
PARTS = {
    "metadata": "value.x = float(face_metadata(push.accel, hit));",
    "uv": "value.xy = surface_uv(push.accel, ray, hit);",
    "position": "value.xyz = surface_position(push.accel, ray, hit);",
    "normal": "value.xyz = surface_normal(push.accel, ray, hit);",
    "both": """SurfacePlace place = surface_place(push.accel, ray, hit);
               value.xyz = normal_at(place, point_at(place)) + vec3(uv0_at(place), 0.0);""",
    "all": """Surface s = surface_at(push.accel, ray, hit);
              value = vec4(s.normal + s.point.position, s.t) + s.tangent + s.color + vec4(s.uv0, s.uv1) +
                      vec4(float(s.is_front), float(s.face_metadata), s.point.offset, s.point.feature);""",
}


counts = {}
with tempfile.TemporaryDirectory() as work:
    for name, body in PARTS.items():
        source, module = (pathlib.Path(work) / (name + suffix) for suffix in (".comp", ".spv"))
        source.write_text(KERNEL % body)
        subprocess.run([glslang, "--quiet", "-V", "--target-env", "vulkan1.2", *(f"-I{f}" for f in folders),
                        "-o", module, source], check=True)
        counts[name] = frozen_spirv.count(module, {105: "false", 106: "false"})
print("instructions:", ", ".join(f"{name} {count}" for name, count in counts.items()))
assert counts["metadata"] < counts["uv"] < counts["both"], counts
assert counts["position"] < counts["normal"] < counts["both"] < counts["all"], counts
# The code that normal and uv share, for the triangle and the point on it, exists once; the normal has no code of the
# uv.
assert counts["both"] - counts["normal"] > 30, counts
assert counts["metadata"] * 4 < counts["normal"], counts
