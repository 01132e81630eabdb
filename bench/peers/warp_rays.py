# SPDX-License-Identifier: MIT
"""Warp's hits, for python_rays.py."""
import warp as wp


@wp.kernel
def closest(
    mesh: wp.uint64,
    origins: wp.array(dtype=wp.vec3),
    directions: wp.array(dtype=wp.vec3),
    t: wp.array(dtype=float),
):
    i = wp.tid()
    query = wp.mesh_query_ray(mesh, origins[i], directions[i], 1.0e6)
    t[i] = wp.where(query.result, query.t, wp.inf)


@wp.kernel
def any_hit(
    mesh: wp.uint64,
    origins: wp.array(dtype=wp.vec3),
    directions: wp.array(dtype=wp.vec3),
    t: wp.array(dtype=float),
):
    i = wp.tid()
    t[i] = wp.where(wp.mesh_query_ray_anyhit(mesh, origins[i], directions[i], 1.0e6), 1.0, wp.inf)
