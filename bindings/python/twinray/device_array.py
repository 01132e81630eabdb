"""Arrays in the memory of a scene's device, which NumPy, PyTorch and CuPy access without a copy.

Memory exported by Vulkan is imported into CUDA with CUDA's driver interface, which comes with NVIDIA's driver.
"""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _core

if TYPE_CHECKING:
    from .scene import Scene

#: The result of `Scene.trace` for each ray; ``t_hit`` of a miss is -1.
HIT = np.dtype(
    [
        ("is_hit", np.uint32),
        ("t_hit", np.float32),
        ("primitive_ids", np.uint32),
        ("geometry_ids", np.uint32),
        ("u", np.float32),
        ("v", np.float32),
        ("instance", np.uint32),
        ("flags", np.uint32),
    ]
)


_OPAQUE_FD = 1  # CU_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD


class _Uuid(ctypes.Structure):
    _fields_ = [("bytes", ctypes.c_ubyte * 16)]


class _HandleDesc(ctypes.Structure):  # CUDA_EXTERNAL_MEMORY_HANDLE_DESC
    _fields_ = [
        ("type", ctypes.c_int),
        ("fd", ctypes.c_int64),  # of a union of 16 bytes
        ("rest_of_union", ctypes.c_uint64),
        ("size", ctypes.c_ulonglong),
        ("flags", ctypes.c_uint),
        ("reserved", ctypes.c_uint * 16),
    ]


class _BufferDesc(ctypes.Structure):  # CUDA_EXTERNAL_MEMORY_BUFFER_DESC
    _fields_ = [
        ("offset", ctypes.c_ulonglong),
        ("size", ctypes.c_ulonglong),
        ("flags", ctypes.c_uint),
        ("reserved", ctypes.c_uint * 16),
    ]


def _driver():
    try:
        return ctypes.CDLL("libcuda.so.1")
    except OSError as error:
        raise BufferError(f"CUDA's driver cannot be loaded: {error}") from None


class _ImportedMemory:
    """Exported memory in the primary context of the CUDA device with its UUID. Raises BufferError with the reason."""

    def __init__(self, memory):
        self._memory = memory  # lives as long as this
        self._cuda = _driver()
        self._call("cuInit", 0)
        self._device = self._device_with(bytes(memory.device_uuid()))
        self._context = ctypes.c_void_p()
        self._external = ctypes.c_void_p()
        self._pointer = ctypes.c_uint64()
        self._call("cuDevicePrimaryCtxRetain", ctypes.byref(self._context), self._device)
        self._in_context(self._import)

    @property
    def pointer(self):
        """The device address, an int."""
        return self._pointer.value

    def synchronize(self):
        """Wait for all of CUDA's work in the context."""
        self._in_context(lambda: self._call("cuCtxSynchronize"))

    def __del__(self):
        if getattr(self, "_context", None):
            self._in_context(self._release)
            self._call("cuDevicePrimaryCtxRelease", self._device)

    def _import(self):
        fd, size = self._memory.export_fd()
        handle = _HandleDesc(type=_OPAQUE_FD, fd=fd, size=size)
        try:
            self._call("cuImportExternalMemory", ctypes.byref(self._external), ctypes.byref(handle))
        except BufferError:
            os.close(fd)  # after a success CUDA owns it
            raise
        whole = _BufferDesc(size=size)
        self._call("cuExternalMemoryGetMappedBuffer", ctypes.byref(self._pointer), self._external, ctypes.byref(whole))

    def _release(self):
        if self._pointer:
            self._call("cuMemFree_v2", self._pointer)
        if self._external:
            self._call("cuDestroyExternalMemory", self._external)

    def _in_context(self, work):
        self._call("cuCtxPushCurrent_v2", self._context)
        try:
            return work()
        finally:
            self._call("cuCtxPopCurrent_v2", ctypes.byref(ctypes.c_void_p()))

    def _device_with(self, uuid):
        count = ctypes.c_int()
        self._call("cuDeviceGetCount", ctypes.byref(count))
        for i in range(count.value):
            device, found = ctypes.c_int(), _Uuid()
            self._call("cuDeviceGet", ctypes.byref(device), i)
            self._call("cuDeviceGetUuid", ctypes.byref(found), device)
            if bytes(found.bytes) == uuid:
                return device
        raise BufferError(f"none of the {count.value} CUDA devices is the scene's device")

    def _call(self, name, *arguments):
        status = getattr(self._cuda, name)(*arguments)
        if status != 0:
            raise BufferError(f"{name} of CUDA failed with status {status}")


class DeviceArray:
    """An array in the memory of a scene's device, made by `Scene.device_array`.

    On an NVIDIA GPU use ``torch.as_tensor(array, device="cuda")`` or ``cupy.asarray(array)``, through
    ``__cuda_array_interface__``. On a CPU use ``numpy.asarray(array)`` or ``torch.from_dlpack(array)``. All of them
    share its memory. So does a field of hits, such as ``hits["t_hit"]``, which is also a `DeviceArray`.

    Attributes
    ----------
    shape : tuple of int
    dtype : numpy.dtype
    """

    def __init__(self, memory: Any, shape: tuple[int, ...], dtype: np.dtype, offset: int = 0) -> None:
        self._memory = memory
        self._imported: list[_ImportedMemory] = []  # shared with fields
        self.shape = shape
        self.dtype = dtype
        self._offset = offset
        self._strides = _strides(shape, dtype.itemsize)

    def __repr__(self) -> str:
        return f"<twinray.DeviceArray {self.shape} of {self.dtype}>"

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, field: str) -> DeviceArray:
        if not isinstance(field, str) or self.dtype.fields is None or field not in self.dtype.fields:
            raise KeyError(
                f"{field!r} is not a field of {self.dtype}; to slice, convert the array with NumPy, PyTorch or CuPy"
            )
        dtype, offset = self.dtype.fields[field][:2]
        part = DeviceArray(self._memory, self.shape + dtype.shape, dtype.base, self._offset + offset)
        part._strides = self._strides + _strides(dtype.shape, dtype.base.itemsize)
        part._imported = self._imported
        return part

    def numpy(self) -> NDArray:
        """Return a NumPy array: the same memory on a CPU, else a copy."""
        mapped = self._memory.mapped()
        bytes_ = self._memory.download() if mapped is None else mapped
        return np.ndarray(self.shape, self.dtype, bytes_, self._offset, self._strides)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray:
        array = self._on_host()
        if dtype is not None and np.dtype(dtype) != array.dtype:
            if copy is False:
                raise ValueError(f"the array has dtype {array.dtype}; {np.dtype(dtype)} would require a copy")
            return array.astype(dtype)
        return array.copy() if copy else array

    def __dlpack__(self, **options: Any) -> Any:
        return self._on_host().__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self._on_host().__dlpack_device__()

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        if self._memory.mapped() is not None:
            raise AttributeError("__cuda_array_interface__: the array is in the host's memory")
        if not self._imported:
            self._imported.append(_ImportedMemory(self._memory))
        return {
            "shape": self.shape,
            "typestr": self.dtype.str,
            "descr": self.dtype.descr,
            "data": (self._imported[0].pointer + self._offset, False),
            "strides": self._strides,
            "version": 3,
        }

    def export_fd(self) -> tuple[int, int]:
        """Return a new file descriptor of the memory, and its size in bytes.

        Vulkan, CUDA and HIP import it as an opaque handle. The caller closes it or transfers it.
        """
        return self._memory.export_fd()

    def synchronize(self) -> None:
        """Wait for CUDA's work on the array."""
        for imported in self._imported:
            imported.synchronize()

    def _is_packed(self):
        return self._offset == 0 and self._strides == _strides(self.shape, self.dtype.itemsize)

    def _on_host(self):
        if self._memory.mapped() is None:
            raise BufferError("the array is in the GPU's memory; .numpy() copies it")
        return self.numpy()


def device_array(scene: Scene, shape: int | tuple[int, ...], dtype: DTypeLike = np.float32) -> DeviceArray:
    """Implement `Scene.device_array`."""
    sizes = (shape,) if hasattr(shape, "__index__") else tuple(shape)
    if not all(hasattr(n, "__index__") and n.__index__() >= 0 for n in sizes):
        raise ValueError(f"shape: {shape!r}; expected integers of at least 0")
    sizes = tuple(n.__index__() for n in sizes)
    kind = np.dtype(dtype)
    count = int(np.prod(sizes, dtype=object)) * kind.itemsize
    if count == 0 or count >= 2**63:
        raise ValueError(f"shape: {shape!r}; an array of {count} bytes cannot be shared")
    return DeviceArray(_core.DeviceMemory(scene._core, count, scene.backend["kind"] == "CPU"), sizes, kind)


def trace(scene: Scene, rays: DeviceArray, hits: DeviceArray | None, any_hit: bool) -> DeviceArray:
    """Implement `Scene.trace`."""
    if not isinstance(rays, DeviceArray):
        raise TypeError(f"rays: {type(rays).__name__} is not a DeviceArray; Scene.device_array creates one")
    if rays.dtype != np.float32 or len(rays.shape) != 2 or rays.shape[1] != 8 or not rays._is_packed():
        raise ValueError(f"rays: {rays.shape} of {rays.dtype}; expected (n, 8) of float32")
    hits = device_array(scene, len(rays), HIT) if hits is None else hits
    if not isinstance(hits, DeviceArray):
        raise TypeError(f"hits: {type(hits).__name__} is not a DeviceArray; Scene.device_array creates one")
    if hits.dtype != HIT or hits.shape != rays.shape[:1] or not hits._is_packed():
        raise ValueError(f"hits: {hits.shape} of {hits.dtype}; expected {rays.shape[:1]} of twinray.HIT")
    rays.synchronize()
    hits.synchronize()
    _core.trace(scene._core, rays._memory, hits._memory, len(rays), any_hit)
    return hits


def _strides(shape, step):
    strides = []
    for size in reversed(shape):
        strides.insert(0, step)
        step *= size
    return tuple(strides)
