"""Warp's hits, for python_rays.py."""
import warp as wp


@wp.kernel
def trace(
    mesh: wp.uint64,
    origins: wp.array(dtype=wp.vec3),
    directions: wp.array(dtype=wp.vec3),
    is_any: bool,
    t: wp.array(dtype=float),
):
    i = wp.tid()
    if is_any:
        t[i] = wp.where(wp.mesh_query_ray_anyhit(mesh, origins[i], directions[i], 1.0e6), 1.0, wp.inf)
    else:
        query = wp.mesh_query_ray(mesh, origins[i], directions[i], 1.0e6)
        t[i] = wp.where(query.result, query.t, wp.inf)
