#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: the glTF exporter of Blender as a Python package compresses where it is asked to, by Draco or by
# meshopt, or fails. The package of 5.0.1 compresses by Draco.
# Seen: with bpy 5.2.3 from PyPI, export_scene.gltf(export_draco_mesh_compression_enable=True), and the same with
# export_meshopt_compression_enable and either extension, return {'FINISHED'} and write the bytes of the export without
# compression: no extension is named. A line of the log says that a library is not there; libdraco and libmeshoptimizer
# are in the package, the bridges to them (libbf_intern_draco_bridge.so, libbf_intern_meshopt_bridge.so) are not.
# Seen with bpy 5.2.3 on Python 3.13 on 2026-11-30. Needs Python 3.13, 1.5 GB and no root.
folder=$(mktemp -d)
pythons=3.13
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv bpy==5.2.3 numpy==2.4.6

cat >export.py <<'END'
import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
meshopt = {"export_meshopt_compression_enable": True}
for name, options in {
    "plain": {},
    "draco": {"export_draco_mesh_compression_enable": True},
    "ext": {**meshopt, "export_meshopt_extension": "EXT_meshopt_compression"},
    "khr": {**meshopt, "export_meshopt_extension": "KHR_meshopt_compression"},
}.items():
    done = bpy.ops.export_scene.gltf(filepath=f"{name}.glb", **options)
    with open("results", "a") as file:
        file.write(f"{name} {' '.join(done)}\n")
END
venv/bin/python export.py >log 2>&1
for name in draco ext khr; do
    same "$name returns" "$(grep "^$name" results | cut -d' ' -f2)" FINISHED
    holds "$name.glb has the bytes of plain.glb" "$(cmp -s plain.glb "$name.glb" && echo 1 || echo 0)"
    same "extensions of compression in $name.glb" "$(grep -ca '_compression"' "$name.glb" || true)" 0
done
parts=$(find venv -path '*/bpy/lib/*' -printf '%f\n')
for library in libdraco libmeshoptimizer; do
    holds "the package has $library" "$(($(grep -c "^$library" <<<"$parts") > 0))"
done
same "bridges in the package" "$(grep -c 'bf_intern_.*_bridge' <<<"$parts" || true)" 0
same "lines of the log about them" "$(grep -c 'is not available because library could not be found' log)" 2
conclude
