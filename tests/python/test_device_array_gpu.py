# SPDX-License-Identifier: MIT
"""Arrays in a GPU's memory, which PyTorch and CuPy see by CUDA: only where such a GPU, and one of them, is there."""

import numpy as np
import pytest
import twinray
from test_device_array import check, scene_and_rays


def on_a_gpu(package):
    module = pytest.importorskip(package)
    scene, rays = scene_and_rays()
    if scene.backend["kind"] == "CPU":
        pytest.skip("the device's memory is the host's")
    return module, scene, rays


def test_pytorch_writes_rays_and_reads_hits_in_place():
    torch, scene, rays = on_a_gpu("torch")
    shared = scene.device_array(rays.shape)
    tensor = torch.as_tensor(shared, device="cuda")
    assert tensor.shape == shared.shape and tensor.is_cuda
    tensor.copy_(torch.from_numpy(rays))
    assert (shared.numpy() == rays).all()  # as Vulkan reads it back
    hits = scene.trace(shared)
    check(hits.numpy(), scene, rays)
    t = torch.as_tensor(hits["t_hit"], device="cuda")
    assert (t.cpu().numpy() == hits.numpy()["t_hit"]).all()
    tensor[:, 7] = 0.25  # on CUDA's stream, which trace waits for
    scene.trace(shared, hits)
    expected = hits.numpy()["t_hit"]
    assert ((expected <= 0.25) | (expected == -1)).all() and (t.cpu().numpy() == expected).all()
    del shared, hits, scene
    assert (t.cpu().numpy() == expected).all()  # memory lives as long as its views


def test_cupy_writes_rays_and_reads_hits_in_place():
    cupy, scene, rays = on_a_gpu("cupy")
    shared = scene.device_array(rays.shape)
    cupy.asarray(shared)[...] = cupy.asarray(rays)
    hits = scene.trace(shared)
    check(hits.numpy(), scene, rays)
    ids = cupy.asarray(hits["primitive_ids"])
    assert ids.dtype == np.uint32 and (ids.get() == hits.numpy()["primitive_ids"]).all()
    met = cupy.asarray(hits["is_hit"]) != 0
    assert int(met.sum()) == int((hits.numpy()["is_hit"] != 0).sum())


def test_numpy_sees_a_copy_alone():
    _, scene, rays = on_a_gpu("twinray")
    shared = scene.device_array(rays.shape)
    with pytest.raises(BufferError, match="GPU's memory"):
        np.asarray(shared)
    assert shared.numpy().shape == rays.shape
    assert twinray.HIT == scene.trace(shared).dtype
