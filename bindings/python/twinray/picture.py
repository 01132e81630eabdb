"""Pictures of scenes, rays and hits, rendered with the scene's own rays; notebooks display them.

The window of the command ``twinray view`` shows a scene through a temporary file.
"""

from __future__ import annotations

import base64
import os
import shutil
import struct
import subprocess
import tempfile
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import array_of, number_of, rows_of, vector_of

if TYPE_CHECKING:
    from .scene import Scene

# Okabe and Ito's colours, which people of any colour vision tell apart ("Color Universal Design", 2008).
_GREY, _ORANGE, _BLUE = np.array([(158, 158, 158), (213, 94, 0), (0, 114, 178)]) / 255
_GEOMETRIES = (
    np.array([(176, 184, 192), (230, 186, 110), (134, 196, 224), (120, 190, 165), (222, 170, 196), (210, 204, 150)])
    / 255
)
# Nine colours of viridis (van der Walt and Smith, 2015), which gets brighter in even steps.
_VIRIDIS = (
    np.array(
        [
            (68, 1, 84),
            (71, 45, 123),
            (59, 82, 139),
            (44, 114, 142),
            (33, 145, 140),
            (40, 174, 128),
            (94, 201, 98),
            (173, 220, 48),
            (253, 231, 37),
        ]
    )
    / 255
)
_BACKGROUND = 1.0
_SAMPLES = 2  # along each side of a pixel
_MOST_RAYS = 2000  # the most that are drawn
_HIDDEN = 0.2  # how much is seen of a ray behind a surface


class Picture:
    """An image that notebooks display and `save` writes as PNG.

    Attributes
    ----------
    pixels : (height, width, 3) uint8
    value_range : (float, float), or None
        The values of the darkest and the brightest colour.
    """

    def __init__(self, pixels: NDArray[np.uint8], value_range: tuple[float, float] | None = None) -> None:
        self.pixels = pixels
        self.value_range = value_range

    def save(self, file: str | os.PathLike[str]) -> None:
        """Write the image as PNG."""
        with open(file, "wb") as out:
            out.write(self._repr_png_())

    def _repr_png_(self) -> bytes:
        height, width, _ = self.pixels.shape
        rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with its filter: none
        rows[:, 1:] = self.pixels.reshape(height, -1)
        chunks = (
            (b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)),
            (b"IDAT", zlib.compress(rows.tobytes(), 6)),
            (b"IEND", b""),
        )
        return b"\x89PNG\r\n\x1a\n" + b"".join(
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
            for kind, data in chunks
        )

    def _repr_html_(self) -> str:
        image = base64.b64encode(self._repr_png_()).decode()
        html = f'<img width="{self.pixels.shape[1]}" src="data:image/png;base64,{image}">'
        if self.value_range is None:
            return html
        colors = ", ".join("rgb({:.0f}, {:.0f}, {:.0f})".format(*(255 * color)) for color in _VIRIDIS)
        bar = f'<span style="display: inline-block; width: 12em; background: linear-gradient(to right, {colors})">'
        return f"{html}<div>{self.value_range[0]:.4g} {bar}&nbsp;</span> {self.value_range[1]:.4g}</div>"


class _Camera:
    def __init__(self, eye, center, up, fov, width, height):
        self.eye, self.center, self.up = eye, center, up
        self.fov, self.width, self.height = fov, width, height
        forward = center - eye
        if not np.linalg.norm(forward) > 0:
            raise ValueError(f"eye: {eye}; the camera is at its center")
        self.forward = forward / np.linalg.norm(forward)
        right = np.cross(self.forward, up)
        if not np.linalg.norm(right) > 0:
            raise ValueError(f"up: {up}; the camera looks along it")
        self.right = right / np.linalg.norm(right)
        self.above = np.cross(self.right, self.forward)
        self.focal = 0.5 * width / np.tan(0.5 * np.deg2rad(fov))

    def rays(self):
        """Rays through all pixels, from the top; directions end on the plane at distance 1, so that t is depth."""
        x = (np.arange(self.width) + 0.5 - 0.5 * self.width) / self.focal
        y = (0.5 * self.height - 0.5 - np.arange(self.height)) / self.focal
        rays = np.empty((self.height, self.width, 6))
        rays[..., :3] = self.eye
        rays[..., 3:] = self.forward + x[None, :, None] * self.right + y[:, None, None] * self.above
        return rays

    def project(self, points):
        """Return columns, rows and depths of points; depths are not positive behind the camera."""
        offset = points - self.eye
        depth = offset @ self.forward
        with np.errstate(divide="ignore", invalid="ignore"):
            x = 0.5 * self.width + self.focal * (offset @ self.right) / depth
            y = 0.5 * self.height - self.focal * (offset @ self.above) / depth
        return x, y, depth


def _camera_for(bounds, eye, center, up, fov, width, height):
    low, high = bounds
    radius = 0.5 * float(np.linalg.norm(high - low)) or 1.0
    center = 0.5 * (low + high) if center is None else center
    if eye is None:
        forward = {0: (0.55, 1, 0.75), 1: (0.75, 0.55, 1), 2: (0.75, -1, 0.55)}[int(np.argmax(np.abs(up)))]
        half_angle = 0.5 * np.deg2rad(fov) * min(1.0, height / width)
        eye = center + np.array(forward) / np.linalg.norm(forward) * radius / np.sin(half_angle)
    return _Camera(eye, center, up, fov, width, height)


def colors_of(values, value_range=None):
    """Return viridis colours (n, 3), grey for NaN, and the range of values that they span."""
    finite = values[np.isfinite(values)]
    low, high = value_range or ((finite.min(), finite.max()) if finite.size else (0.0, 1.0))
    place = np.clip((values - low) / (high - low) if high > low else np.zeros_like(values), 0, 1)
    steps = np.linspace(0, 1, len(_VIRIDIS))
    colors = np.stack([np.interp(place, steps, _VIRIDIS[:, i]) for i in range(3)], axis=-1)
    colors[np.isnan(values)] = _GREY
    return colors, (float(low), float(high))


def _range_above(before, behind):
    """Return the part of each line between two heights that is above 0, as fractions; empty if begin >= end."""
    with np.errstate(divide="ignore", invalid="ignore"):
        cut = before / (before - behind)
    begin = np.where(before >= 0, 0.0, np.where(behind > 0, cut, 1.0))
    end = np.where(behind >= 0, 1.0, np.where(before > 0, cut, 0.0))
    return begin, end


class _Canvas:
    """Colours and depths of pixels. Points and lines are faint behind nearer surfaces."""

    def __init__(self, scene, camera, face_colors):
        self.camera = camera
        found = scene.cast_rays(camera.rays())
        self.depth = np.asarray(found["t_hit"], np.float64)
        is_hit = np.isfinite(self.depth)
        geometry = found["geometry_ids"][is_hit].astype(np.int64)
        if face_colors is None:
            color = _GEOMETRIES[geometry % len(_GEOMETRIES)]
        else:
            color = face_colors[scene.first_faces()[geometry].astype(np.int64) + found["primitive_ids"][is_hit]]
        toward = camera.rays()[is_hit][:, 3:]
        toward /= np.linalg.norm(toward, axis=1, keepdims=True)
        facing = np.abs(np.einsum("ij,ij->i", toward, found["primitive_normals"][is_hit].astype(np.float64)))
        self.color = np.full(self.depth.shape + (3,), _BACKGROUND)
        self.color[is_hit] = color * (0.35 + 0.65 * facing[:, None])

    def dots(self, points, colors, radius):
        """Draw discs with a radius in pixels of the canvas."""
        reach = np.arange(-int(radius), int(radius) + 1)
        dx, dy = np.meshgrid(reach, reach)
        inside = dx**2 + dy**2 <= radius**2
        dx, dy = dx[inside], dy[inside]
        x, y, depth = self.camera.project(points)
        drawn = (depth > 0) & (np.abs(x) < 1e6) & (np.abs(y) < 1e6)
        x, y, depth, colors = (a[drawn] for a in (x, y, depth, np.broadcast_to(colors, points.shape)))
        column = (np.floor(x).astype(np.int64)[:, None] + dx).ravel()
        row = (np.floor(y).astype(np.int64)[:, None] + dy).ravel()
        depth, colors = np.repeat(depth, len(dx)), np.repeat(colors, len(dx), axis=0)
        within = (column >= 0) & (column < self.camera.width) & (row >= 0) & (row < self.camera.height)
        column, row, depth, colors = (a[within] for a in (column, row, depth, colors))
        order = np.argsort(-depth, kind="stable")  # the nearest last
        column, row, depth, colors = (a[order] for a in (column, row, depth, colors))
        is_seen = depth <= self.depth[row, column] * (1 + 2e-3)
        hidden = ~is_seen
        before = self.color[row[hidden], column[hidden]]
        self.color[row[hidden], column[hidden]] = before + _HIDDEN * (colors[hidden] - before)
        self.color[row[is_seen], column[is_seen]] = colors[is_seen]

    def lines(self, starts, ends, colors, radius):
        """Draw lines as dots one pixel apart, clipped to the picture."""
        near = 1e-3 * float(np.linalg.norm(self.camera.center - self.camera.eye))
        depths = [(p - self.camera.eye) @ self.camera.forward for p in (starts, ends)]
        begin, end = _range_above(depths[0] - near, depths[1] - near)
        kept = begin < end
        way = (ends - starts)[kept]
        starts, ends = starts[kept] + begin[kept, None] * way, starts[kept] + end[kept, None] * way
        (x0, y0, z0), (x1, y1, z1) = self.camera.project(starts), self.camera.project(ends)
        begin, end = np.zeros(len(starts)), np.ones(len(starts))
        for before, behind in ((x0, x1), (y0, y1), (self.camera.width - x0, self.camera.width - x1),
                               (self.camera.height - y0, self.camera.height - y1)):  # fmt: skip
            first, last = _range_above(before + radius, behind + radius)
            begin, end = np.maximum(begin, first), np.minimum(end, last)
        steps = np.where(begin < end, np.ceil((end - begin) * np.hypot(x1 - x0, y1 - y0)) + 1, 0).astype(np.int64)
        line = np.repeat(np.arange(len(starts)), steps)
        step = np.arange(len(line)) - np.repeat(np.cumsum(steps) - steps, steps)
        along = begin[line] + (end - begin)[line] * step / np.maximum(steps[line] - 1, 1)
        # Even steps on the screen are uneven ones in space.
        share = along * z0[line] / (along * z0[line] + (1 - along) * z1[line])
        points = starts[line] + share[:, None] * (ends - starts)[line]
        self.dots(points, colors[kept][line], radius)

    def pixels(self):
        height, width = (n // _SAMPLES for n in self.depth.shape)
        mean = self.color.reshape(height, _SAMPLES, width, _SAMPLES, 3).mean(axis=(1, 3))
        return np.rint(255 * np.clip(mean, 0, 1)).astype(np.uint8)


def _segments(scene, rays, t_hit, length):
    """Return starts and ends of rays, or of an even sample of many rays, and whether they hit."""
    flat, shape = rows_of(rays, "rays", np.float64, 6)
    if t_hit is None:
        t = np.asarray(scene.cast_rays(flat)["t_hit"], np.float64)
    else:
        t = array_of(t_hit, "t_hit").astype(np.float64).reshape(-1)
        if len(t) != len(flat):
            raise ValueError(f"t_hit: {len(t)} numbers, of rays {len(flat)}")
    chosen = slice(None, None, max(1, -(-len(flat) // _MOST_RAYS)))
    flat, t = flat[chosen], t[chosen]
    is_hit = np.isfinite(t)
    speed = np.linalg.norm(flat[:, 3:], axis=1)
    kept = np.isfinite(flat).all(axis=1) & (speed > 0)
    flat, t, is_hit, speed = (a[kept] for a in (flat, t, is_hit, speed))
    ends = flat[:, :3] + np.where(is_hit, t, length / speed)[:, None] * flat[:, 3:]
    return flat[:, :3], ends, is_hit


def show(
    scene: Scene,
    rays: ArrayLike | None = None,
    t_hit: ArrayLike | None = None,
    *,
    points: ArrayLike | None = None,
    point_values: ArrayLike | None = None,
    values: ArrayLike | None = None,
    value_range: tuple[float, float] | None = None,
    point_size: float = 5.0,
    eye: ArrayLike | None = None,
    center: ArrayLike | None = None,
    up: ArrayLike = (0, 1, 0),
    fov_deg: float = 40.0,
    size: tuple[int, int] = (640, 480),
    interactive: bool = False,
) -> Any:
    """Implement `Scene.show`."""
    upward = vector_of(up, "up")
    width, height = size
    if not (0 < width <= 8192 and 0 < height <= 8192):
        raise ValueError(f"size: {size}; expected a width and a height from 1 to 8192")
    fov = number_of(fov_deg, "fov_deg", 0)
    if not 0 < fov < 180:
        raise ValueError(f"fov_deg: {fov}; expected an angle between 0 and 180")
    low, high = scene.bounds()
    drawn, _ = rows_of(np.zeros((0, 3)) if points is None else points, "points", np.float64, 3)
    if not np.isfinite([low, high]).all():
        low, high = (drawn.min(axis=0), drawn.max(axis=0)) if len(drawn) else (np.zeros(3), np.ones(3))
    face_colors, spanned = None, None
    if values is not None:
        numbers = _numbers(values, "values")
        faces = int(scene.first_faces()[-1])
        if numbers.shape != (faces,):
            raise ValueError(f"values: shape {numbers.shape}; expected ({faces},), one number per face")
        face_colors, spanned = colors_of(numbers, value_range)
    length = float(np.linalg.norm(high - low)) or 1.0
    segments = None if rays is None else _segments(scene, rays, t_hit, length)
    if interactive:
        return _interactive(scene, face_colors, segments, drawn)
    viewed = [None if p is None else vector_of(p, name) for p, name in ((eye, "eye"), (center, "center"))]
    camera = _camera_for((low, high), viewed[0], viewed[1], upward, fov, _SAMPLES * width, _SAMPLES * height)
    canvas = _Canvas(scene, camera, face_colors)
    if segments is not None:
        starts, ends, is_hit = segments
        canvas.lines(starts, ends, np.where(is_hit[:, None], _ORANGE, _BLUE), 1)
        canvas.dots(ends[is_hit], _ORANGE, 4)
    if len(drawn):
        dot_colors = np.broadcast_to(_BLUE, drawn.shape)
        if point_values is not None:
            numbers = _numbers(point_values, "point_values").reshape(-1)
            if len(numbers) != len(drawn):
                raise ValueError(f"point_values: {len(numbers)} numbers, of points {len(drawn)}")
            dot_colors, spanned = colors_of(numbers, value_range or spanned)
        canvas.dots(drawn, dot_colors, _SAMPLES * number_of(point_size, "point_size", 0) / 2)
    return Picture(canvas.pixels(), spanned)


def _numbers(values, name):
    """Convert numbers or truth values to float64."""
    array = np.asarray(values)
    return (array if array.dtype == bool else array_of(values, name)).astype(np.float64)


def _interactive(scene, face_colors, segments, points):
    """Open a window or widget of PyVista, or of trimesh if PyVista is not installed."""
    try:
        import pyvista
    except ImportError:
        return _in_trimesh(scene, face_colors, segments, points)
    plotter = pyvista.Plotter()
    triangles = scene.world_triangles()
    surface = pyvista.PolyData.from_regular_faces(triangles, np.arange(len(triangles)).reshape(-1, 3))
    if face_colors is None:
        plotter.add_mesh(surface, color=_GEOMETRIES[0])
    else:
        plotter.add_mesh(surface, scalars=np.rint(255 * face_colors).astype(np.uint8), rgb=True)
    if segments is not None:
        starts, ends, is_hit = segments
        for chosen, color in ((is_hit, _ORANGE), (~is_hit, _BLUE)):
            if chosen.any():
                lines = np.stack([starts[chosen], ends[chosen]], axis=1).reshape(-1, 3)
                plotter.add_lines(lines, color=color, width=2)
    if len(points):
        plotter.add_points(points, color=_BLUE)
    return plotter.show()


def _in_trimesh(scene, face_colors, segments, points):
    try:
        import trimesh
    except ImportError:
        raise ImportError("interactive: requires PyVista or trimesh; neither is installed") from None
    mesh = scene.to_trimesh()
    if face_colors is not None:
        mesh.visual.face_colors = np.rint(255 * face_colors).astype(np.uint8)
    parts = [mesh]
    if segments is not None:
        parts.append(trimesh.load_path(np.stack(segments[:2], axis=1)))
    if len(points):
        parts.append(trimesh.PointCloud(points))
    return trimesh.Scene(parts).show()


_folders: list[
    tempfile.TemporaryDirectory[str]
] = []  # kept until this program ends, because the window may read the file again


def _write_ply(file, triangles):
    """Write triangles (3 m, 3) as binary PLY in float64."""
    faces = np.empty(len(triangles) // 3, np.dtype([("count", "u1"), ("vertices", "<i4", 3)]))
    faces["count"] = 3
    faces["vertices"] = np.arange(len(triangles)).reshape(-1, 3)
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(triangles)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(file, "wb") as out:
        out.write(header.encode() + triangles.astype("<f8").tobytes() + faces.tobytes())


def view(scene: Scene, *options: str) -> subprocess.Popen[bytes]:
    """Implement `Scene.view`."""
    command = shutil.which(os.environ.get("TWINRAY_COMMAND", "twinray"))
    if command is None:
        raise FileNotFoundError("view: the command twinray is not in PATH, and TWINRAY_COMMAND does not name it")
    _folders.append(tempfile.TemporaryDirectory(prefix="twinray"))
    file = os.path.join(_folders[-1].name, "scene.ply")
    _write_ply(file, scene.world_triangles())
    return subprocess.Popen([command, "view", file, *options])
