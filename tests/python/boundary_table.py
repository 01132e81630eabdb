"""Shares of 10^4 rays that hit where a ray begins or ends exactly on a triangle, or meets a border.

Run it where open3d, trimesh and embreex are installed: python tests/python/boundary_table.py. Coordinates are whole
numbers of 1/256, so float32 holds every origin, end and plane, and a point named as on the plane lies on it exactly.
"""

import numpy as np
import open3d
import trimesh
import twinray

RAYS = 10_000
NONE = twinray.INVALID_ID
random = np.random.default_rng(7)


def whole(low, high, shape):
    """Multiples of 1/256 between two whole numbers."""
    return random.integers(256 * low, 256 * high, shape) / 256


def pieces():
    """A triangle (3, 3) and a point of its inside, on its plane exactly, for each ray."""
    weights = np.array([0.25, 0.25, 0.5])
    corners = 4 * whole(-8, 8, (RAYS, 3, 3))  # so that weighted sums, too, are multiples of 1/256
    return corners, np.einsum("i,rij->rj", weights, corners)


def cases():
    """Name, vertices, triangles, rays, end of rays, and whether each ray has a triangle of its own."""
    corners, inside = pieces()
    apart = 256.0 * np.stack([np.arange(RAYS) % 100, np.arange(RAYS) // 100, 0 * np.arange(RAYS)], axis=1)
    vertices = (corners + apart[:, None, :]).reshape(-1, 3)
    triangles = np.arange(3 * RAYS).reshape(-1, 3)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    steps = (2 * normal + random.uniform(-0.5, 0.5, (RAYS, 3))).round(2) // (1 / 256) / 256  # at most 23 degrees off
    inside = inside + apart
    yield "begins in the plane", vertices, triangles, np.hstack([inside, steps]), np.inf, True
    for end in (1.0, 1 - 1e-5):
        yield f"ends in it, tfar = {end}", vertices, triangles, np.hstack([inside - steps, steps]), end, True
    square = np.array([[0, 0, 0], [64, 0, 0], [64, 64, 0], [0, 64, 0]], float)
    halves = np.array([[0, 1, 2], [0, 2, 3]])
    along = whole(1, 63, RAYS)
    places = {"low border": (along, 0 * along), "high border": (along, 0 * along + 64), "diagonal": (along, along)}
    for name, (x, y) in places.items():
        rays = np.stack([x, y, 0 * x + 5, 0 * x, 0 * x, 0 * x - 1], axis=1)
        yield f"{name} of a square", square, halves, rays, np.inf, False


def first_by_twinray(accel, level):
    def first(vertices, triangles, rays, end):
        scene = twinray.Scene(accel, level=level, origin=[0, 0, 0])
        scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
        return scene.cast_rays(rays.astype(np.float32), tfar=end)["primitive_ids"]

    return first


def first_by_open3d(vertices, triangles, rays, end):
    """Its cast_rays takes no end of rays, test_occlusions does; where rays end they meet their own triangle or none."""
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(vertices.astype(np.float32)), open3d.core.Tensor(triangles.astype(np.uint32))
    )
    tensor = open3d.core.Tensor(rays.astype(np.float32))
    if np.isinf(end):
        return scene.cast_rays(tensor)["primitive_ids"].numpy()
    is_hit = scene.test_occlusions(tensor, tfar=end).numpy()
    return np.where(is_hit, np.arange(len(rays)), NONE)


def first_by_trimesh(module):
    def first(vertices, triangles, rays, end):
        if np.isfinite(end):
            return None  # its calls take no end
        mesh = trimesh.Trimesh(vertices, triangles, process=False)
        ids = module.RayMeshIntersector(mesh).intersects_first(rays[:, :3], rays[:, 3:])
        return np.where(ids < 0, NONE, ids)

    return first


def engines():
    for accel in ("sw", "hw"):
        for level in ("fast", "watertight", "refined", "certified"):
            try:
                twinray.Scene(accel, level=level)
            except twinray.Error as error:
                print(f"twinray {accel}, {level}: {error}")
                continue
            yield f"twinray {accel}, {level}", first_by_twinray(accel, level)
    yield f"Open3D {open3d.__version__}", first_by_open3d
    yield "embreex", first_by_trimesh(trimesh.ray.ray_pyembree)
    yield f"trimesh {trimesh.__version__}", first_by_trimesh(trimesh.ray.ray_triangle)


def share(ids, has_own):
    if ids is None:
        return ""
    return f"{np.mean(ids == np.arange(len(ids)) if has_own else ids != NONE):.2%}"


def main():
    questions = list(cases())
    print("| |", " | ".join(name for name, *_ in questions), "|")
    print("|---|" + "---|" * len(questions))
    for name, first in engines():
        print(f"| {name} |", " | ".join(share(first(*asked), has_own) for _, *asked, has_own in questions), "|")


if __name__ == "__main__":
    main()
