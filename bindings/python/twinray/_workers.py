"""Scenes that are described once and built once in each process that is asked for a part of a result."""

from __future__ import annotations

import hashlib
import json
import os
import re
import threading
from collections import OrderedDict
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arrays import arrays_of_mesh, indices_of, matrix_of, rows_of, vector_of
from .scene import Scene

_MOST_SCENES = 4  # the last ones that a process was asked for, which it keeps


class SceneSpec:
    """The content of a scene, for processes that build it.

    Parameters
    ----------
    *parts
        Each a file's name, a mesh of trimesh, Open3D or PyVista, or a tuple (vertices, triangles) or (vertices,
        triangles, transform). A file must be readable by each worker and stay as it is.
    accel, device, level, origin
        The options of `Scene`. If `device` is None and a machine has several GPUs, its workers share them out.

    Attributes
    ----------
    key : str
        A hash of the content and of twinray's version: equal for equal scenes.
    """

    def __init__(
        self,
        *parts: Any,
        accel: Literal["auto", "sw", "hw"] = "auto",
        device: str | int | None = None,
        level: Literal["fast", "watertight", "refined", "certified"] = "watertight",
        origin: ArrayLike | None = None,
    ) -> None:
        self.parts = [_part_of(part) for part in parts]
        self.options: dict[str, Any] = {
            "accel": accel,
            "device": device,
            "level": level,
            "origin": None if origin is None else vector_of(origin, "origin").tolist(),
        }
        self.key = self._digest()

    @classmethod
    def of(cls, scene: Any) -> SceneSpec:
        """The spec itself, or that of one part."""
        if isinstance(scene, Scene):
            raise TypeError(
                "scene: a Scene is of one process; give a SceneSpec, a mesh, a file or (vertices, triangles)"
            )
        return scene if isinstance(scene, cls) else cls(scene)

    def __dask_tokenize__(self) -> tuple[str, str]:
        return ("twinray.SceneSpec", self.key)

    def __repr__(self) -> str:
        return f"<twinray.dask.SceneSpec of {len(self.parts)} parts, {self.key[:12]}>"

    def face_count(self) -> int:
        """How many triangles there are; a file is loaded for it."""
        if not any(isinstance(part, _File) for part in self.parts):
            return sum(len(triangles) for _, triangles, _ in self.parts)
        return _built(self).scene._core.triangle_count()

    def build(self) -> Scene:
        """Make a scene of it."""
        options = dict(self.options)
        if options["device"] is None:
            options["device"] = _device_of_worker()
        scene = Scene(**options)
        for part in self.parts:
            if isinstance(part, _File):
                part.check()
                scene.add_file(part.name)
            else:
                scene.add_triangles(part[0], part[1], transform=part[2])
        return scene

    def kept(self, name: Any, make: Any) -> Any:
        """Return what `make()` returned, called once for as long as this process keeps the scene."""
        extras = _built(self).extras
        with _changing:
            if repr(name) not in extras:
                extras[repr(name)] = make()
            return extras[repr(name)]

    def _digest(self):
        digest = hashlib.sha256(json.dumps([_core.__version__, self.options], default=str).encode())
        for part in self.parts:
            for array in (part.digest.encode(),) if isinstance(part, _File) else part:
                if not isinstance(array, bytes):
                    digest.update(f"{array.dtype.str}{array.shape}".encode())
                digest.update(array)
        return digest.hexdigest()


class _File:
    def __init__(self, name):
        self.name = os.path.abspath(os.fspath(name))
        self.digest = self._digest()

    def check(self):
        if self._digest() != self.digest:
            raise _core.Error(f"scene file '{self.name}' is another one than when the scene was described")

    def _digest(self):
        digest = hashlib.sha256()
        for name in (self.name, *self._buffers()):
            with open(name, "rb") as file:
                while block := file.read(1 << 20):
                    digest.update(block)
        return digest.hexdigest()

    def _buffers(self):
        """Files of vertices that a .gltf names."""
        if not self.name.lower().endswith(".gltf"):
            return []
        with open(self.name, "rb") as file:
            uris = [buffer.get("uri", "data:") for buffer in json.load(file).get("buffers", [])]
        return [os.path.join(os.path.dirname(self.name), uri) for uri in uris if not uri.startswith("data:")]


def _part_of(part):
    if isinstance(part, str | os.PathLike):
        return _File(part)
    if not isinstance(part, tuple | list):
        part = arrays_of_mesh(part)
    if len(part) not in (2, 3):
        raise ValueError(f"scene: a part of {len(part)} things; wanted are (vertices, triangles[, transform])")
    vertices, _ = rows_of(part[0], "vertices", None, 3)
    matrix = matrix_of(part[2] if len(part) == 3 else None, "transform")
    return np.ascontiguousarray(vertices), indices_of(part[1], "triangles"), matrix


class _Built:
    def __init__(self, scene):
        self.scene = scene
        self.extras = {}


_scenes: OrderedDict[str, _Built] = OrderedDict()
_changing = threading.RLock()


def _built(spec):
    with _changing:
        if spec.key not in _scenes:
            _scenes[spec.key] = _Built(spec.build())
            while len(_scenes) > _MOST_SCENES:
                _scenes.popitem(last=False)
        _scenes.move_to_end(spec.key)
        return _scenes[spec.key]


def forget_scenes() -> None:
    """Let go of all scenes of this process, and of devices, which may be lost."""
    with _changing:
        _scenes.clear()
        _core.forget_devices()


def computed(spec: SceneSpec, work: Any, what: str) -> Any:
    """Return work(scene). If the device fails, open it again and build the scene again, once."""
    return twice(lambda: work(_built(spec).scene), spec, what)


def twice(work: Any, spec: SceneSpec, what: str) -> Any:
    """Return work(). After an Error, open the device again and repeat it once; a second one names chunk and device."""
    try:
        return work()
    except (_core.Error, MemoryError):
        forget_scenes()
    try:
        return work()
    except (_core.Error, MemoryError) as error:
        raise _core.Error(f"{what}, on device '{_device_name(spec)}': {error or 'out of memory'}") from error


def _device_name(spec):
    try:
        return Scene(**{**spec.options, "device": spec.options["device"] or _device_of_worker()}).backend["device"]
    except _core.Error:
        return spec.options["device"] or "default"


def _device_of_worker():
    """Return one of several GPUs, by the worker's number, or None if there is no choice."""
    if "TWINRAY_DEVICE" in os.environ:
        return None
    try:
        from distributed import get_worker

        worker = get_worker()
    except (ImportError, ValueError):
        return None
    return _dealt([device["kind"] for device in _core.devices()], worker.name, worker.address)


def _dealt(kinds, name, address):
    """The index of the device for a worker, by the number that its name is or ends with, else by Slurm's number of the
    task on its machine, else by its port."""
    for kind in ("discrete GPU", "integrated GPU"):
        indices = [i for i, each in enumerate(kinds) if each == kind]
        if len(indices) > 1:
            numbered = re.search(r"\d+$", str(name))
            number = int(numbered[0] if numbered else os.environ.get("SLURM_LOCALID") or address.rsplit(":", 1)[-1])
            return str(indices[number % len(indices)])
        if indices:
            return None
    return None
