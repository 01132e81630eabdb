# SPDX-License-Identifier: MIT
"""Imports memory exported by Vulkan into CUDA, with CUDA's driver interface, which comes with NVIDIA's driver."""

from __future__ import annotations

import ctypes
import os

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


class ImportedMemory:
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
