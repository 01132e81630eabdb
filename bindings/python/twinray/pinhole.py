"""Rays of pinhole cameras, in Open3D's convention."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import Array, array_of, number_of


def create_rays_pinhole(*args: Any, dtype: Any = np.float32, **options: Any) -> Array:
    """Create the rays of a pinhole camera.

    There are two forms. In ``create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px)``, `fov_deg` is the
    horizontal field of view; as in Open3D, pixel x goes along `up` x (`center` - `eye`) and pixel y along `up`. In
    ``create_rays_pinhole(intrinsic_matrix, extrinsic_matrix, width_px, height_px)``, the intrinsic matrix is (3, 3),
    and the extrinsic matrix is (4, 4), from the scene to the camera, which looks along +z.

    Returns
    -------
    Array, (height_px, width_px, 6) float32
        The rays through the pixel centres; their directions end on the plane at distance 1. For a camera far from 0,
        as in UTM coordinates, use ``dtype=numpy.float64``; a scene rounds such rays only relative to its origin.
    """
    is_looking_at = "fov_deg" in options or (args and np.ndim(args[0]) == 0)
    rays = (_rays_looking_at if is_looking_at else _rays_of_matrices)(*args, **options)
    return rays.astype(dtype, copy=False).view(Array)


def _rays_looking_at(fov_deg, center, eye, up, width_px, height_px):
    fov = number_of(fov_deg, "fov_deg", 0)
    center, eye, up = (
        array_of(v, name).astype(np.float64) for v, name in ((center, "center"), (eye, "eye"), (up, "up"))
    )
    forward = (center - eye) / np.linalg.norm(center - eye)
    right = np.cross(up, forward)
    right /= np.linalg.norm(right)
    focal = 0.5 * width_px / np.tan(0.5 * np.deg2rad(fov))
    intrinsic = np.array([[focal, 0, 0.5 * width_px], [0, focal, 0.5 * height_px], [0, 0, 1]])
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = [right, np.cross(forward, right), forward]
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    return _rays_of_matrices(intrinsic, extrinsic, width_px, height_px)


def _rays_of_matrices(intrinsic_matrix, extrinsic_matrix, width_px, height_px):
    intrinsic = array_of(intrinsic_matrix, "intrinsic_matrix").astype(np.float64)
    extrinsic = array_of(extrinsic_matrix, "extrinsic_matrix").astype(np.float64)
    x, y = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
    pixels = np.stack([x, y, np.ones_like(x)], axis=-1)
    to_scene = extrinsic[:3, :3].T @ np.linalg.inv(intrinsic)
    rays = np.empty((height_px, width_px, 6))
    rays[..., :3] = -extrinsic[:3, :3].T @ extrinsic[:3, 3]
    rays[..., 3:] = pixels @ to_scene.T
    return rays
