"""Converts arguments to NumPy arrays of one dtype, or raises an exception that names the argument."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_CPU = (1, 3)  # DLPack's kDLCPU and kDLCUDAHost


class Array(np.ndarray):
    """A NumPy array that also has the methods of Open3D's tensors: ``numpy()``, ``cpu()``, ``isfinite()``."""

    def numpy(self) -> NDArray:
        return self.view(np.ndarray)

    def cpu(self) -> Array:
        return self

    def isfinite(self) -> NDArray[np.bool_]:
        return np.isfinite(self)


def array_of(values, name):
    """Convert to an array of numbers in host memory, without a copy if possible."""
    if hasattr(values, "__dlpack_device__"):
        device = values.__dlpack_device__()[0]
        if getattr(device, "value", device) not in _CPU:  # Open3D's is an enumeration of its own
            raise TypeError(f"{name}: an array in device memory; copy it to the host, or share Scene.device_array")
    if not isinstance(values, np.ndarray) and callable(getattr(values, "numpy", None)):
        values = values.numpy()
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name}: not an array of numbers: {error}") from None
    if array.size == 0 and array.dtype.kind == "f":
        return array
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: dtype {array.dtype}; expected floats or integers")
    return array


def _cast(array, dtype):
    with np.errstate(over="ignore"):  # values beyond float32 become infinite, and hit nothing
        return np.ascontiguousarray(array, dtype=dtype)


def rows_of(values, name, dtype, columns):
    """Convert shape (..., columns) to (n, columns) of the dtype (None keeps it); also return the leading shape."""
    array = array_of(values, name)
    if array.ndim == 0 or array.shape[-1] != columns:
        if array.size != 0 or array.ndim != 1:
            raise ValueError(f"{name}: shape {array.shape}; expected (..., {columns})")
        array = array.reshape(0, columns)
    flat = array.reshape(-1, columns)
    return flat if dtype is None else _cast(flat, dtype), array.shape[:-1]


def rays_of(values):
    """Convert rays to contiguous (n, 6) of float32 or float64; also return the leading shape."""
    flat, shape = rows_of(values, "rays", None, 6)
    return _cast(flat, np.float32 if flat.dtype in (np.float16, np.float32) else np.float64), shape


def vector_of(value, name):
    """Convert shape (3,) to finite float64."""
    array = array_of(value, name).astype(np.float64)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name}: {value!r}; expected three finite numbers")
    return array


def indices_of(values, name):
    """Convert shape (m, 3) to uint32."""
    array = array_of(values, name)
    if array.size == 0:
        return np.zeros((0, 3), np.uint32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: shape {array.shape}; expected (m, 3)")
    if array.dtype.kind == "f":
        raise TypeError(f"{name}: dtype {array.dtype}; expected integers")
    if array.min() < 0 or array.max() > 0xFFFFFFFF:
        raise ValueError(f"{name}: indices from {array.min()} to {array.max()}; they must be from 0 to 2**32 - 1")
    return np.ascontiguousarray(array, dtype=np.uint32)


def matrix_of(values, name):
    """Convert (4, 4) with the last row (0, 0, 0, 1), or (3, 4), to (4, 4) float64; None is the identity."""
    matrix = np.eye(4)
    if values is None:
        return matrix
    array = array_of(values, name)
    if array.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"{name}: shape {array.shape}; expected (4, 4) or (3, 4)")
    if array.shape == (4, 4) and not np.array_equal(array[3], [0, 0, 0, 1]):
        raise ValueError(f"{name}: its last row is {array[3]}, not (0, 0, 0, 1)")
    matrix[:3] = array[:3]
    return matrix


def number_of(value, name, least=None):
    """Convert to a float that is not NaN."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {value!r} is not a number") from None
    if number != number or (least is not None and number < least):
        raise ValueError(f"{name}: {number}; expected a number{'' if least is None else f' of at least {least}'}")
    return number


def count_of(value, name, least, most):
    if not hasattr(value, "__index__") or not least <= value.__index__() <= most:
        raise ValueError(f"{name}: {value!r}; expected an integer from {least} to {most}")
    return value.__index__()


def geometry_of(value, name):
    """Convert to the number of a geometry."""
    try:
        number = value.__index__()
    except AttributeError:
        raise TypeError(f"{name}: {value!r} is not the number of a geometry") from None
    if not 0 <= number < 2**32:
        raise ValueError(f"{name}: {number} is not the number of a geometry")
    return number


def arrays_of_mesh(mesh):
    """Return the vertices and triangles of a mesh of trimesh, Open3D (legacy or tensor) or PyVista."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return mesh.vertices, mesh.faces
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):
        return mesh.vertex.positions.cpu().numpy(), mesh.triangle.indices.cpu().numpy()
    if hasattr(mesh, "points") and hasattr(type(mesh), "regular_faces"):  # reading it raises if faces differ in size
        surface = mesh.triangulate()
        return np.asarray(surface.points), np.asarray(surface.faces).reshape(-1, 4)[:, 1:]
    if hasattr(mesh, "extract_surface"):
        raise TypeError(f"vertex_positions: a {type(mesh).__name__} is not a surface; pass its .extract_surface()")
    raise TypeError(
        f"vertex_positions: {type(mesh).__name__} is not a mesh of trimesh, Open3D or PyVista; pass triangle_indices"
    )
