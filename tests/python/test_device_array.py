"""Arrays in the device's memory. CUDA is played by fake_cuda.c, which maps what the driver exports."""

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import twinray
from conftest import cube, run_python, scene_of


def scene_and_rays(n=1000):
    scene = scene_of(cube(), accel="sw")
    random = np.random.default_rng(1)
    rays = np.zeros((n, 8), np.float32)
    rays[:, :3] = random.uniform(-1, 2, (n, 3))
    rays[:, 4:7] = random.normal(size=(n, 3))
    rays[:, 7] = np.inf
    return scene, rays


def check(hits, scene, rays):
    expected = scene.cast_rays(rays[:, [0, 1, 2, 4, 5, 6]])
    is_hit = np.isfinite(expected["t_hit"])
    assert 0 < is_hit.sum() < len(rays)
    assert (hits["is_hit"] == is_hit).all()
    assert (hits["t_hit"] == np.where(is_hit, expected["t_hit"], -1)).all()
    assert (hits["primitive_ids"][is_hit] == expected["primitive_ids"][is_hit]).all()


def test_numpy_and_the_device_share_memory():
    scene, rays = scene_and_rays()
    shared = scene.device_array(rays.shape)
    if scene.backend["kind"] != "CPU":
        pytest.skip("the device's memory is not the host's")
    np.asarray(shared)[:] = rays
    hits = scene.trace(shared)
    assert hits.shape == (1000,)
    check(np.asarray(hits), scene, rays)
    view = np.from_dlpack(hits["t_hit"])
    assert (view == np.asarray(hits)["t_hit"]).all()
    np.asarray(shared)[0] = [0.3, 0.6, -1, 0, 0, 0, 1, np.inf]
    assert scene.trace(shared, hits) is hits
    assert view[0] == 1  # written again, in the same memory
    np.asarray(shared)[0, 7] = 0.5
    scene.trace(shared, hits, any_hit=True)
    assert np.asarray(hits["is_hit"])[0] == 0
    del hits, shared, scene
    assert view[0] == -1  # as the last trace left it: memory lives as long as its views


def test_bad_arrays_are_named():
    scene, rays = scene_and_rays()
    with pytest.raises(TypeError, match="rays: ndarray is not a DeviceArray"):
        scene.trace(rays)
    with pytest.raises(ValueError, match=r"rays: \(4, 6\)"):
        scene.trace(scene.device_array((4, 6)))
    rows = np.dtype([("ray", np.float32, 8), ("more", np.float32, 8)])
    with pytest.raises(ValueError, match="rays: "):
        scene.trace(scene.device_array(4, rows)["ray"])
    with pytest.raises(ValueError, match="would require a copy"):
        scene.device_array(4).__array__(np.float64, copy=False)
    with pytest.raises(ValueError, match="hits: "):
        scene.trace(scene.device_array((4, 8)), scene.device_array(5, twinray.HIT))
    with pytest.raises(ValueError, match="shape: "):
        scene.device_array((-1, 8))
    with pytest.raises(ValueError, match="shape: "):
        scene.device_array(0)
    with pytest.raises(KeyError, match="not a field"):
        scene.device_array(4, twinray.HIT)["t"]
    with pytest.raises(AttributeError, match="host's memory"):
        scene.device_array(4).__cuda_array_interface__  # noqa: B018


def fake_cuda(folder):
    compiler = shutil.which("cc")
    if not compiler:
        pytest.skip("no C compiler")
    library = folder / "libcuda.so.1"
    source = Path(__file__).with_name("fake_cuda.c")
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", library, source], check=True)
    return library


WITH_CUDA = """
import ctypes, numpy as np, twinray
from twinray import _core, device_array
import test_device_array as test
scene, rays = test.scene_and_rays()
memories = [_core.DeviceMemory(scene._core, 32 * len(rays), False) for _ in range(2)]  # as on a GPU
shared = device_array.DeviceArray(memories[0], rays.shape, np.dtype(np.float32))
hits = device_array.DeviceArray(memories[1], (len(rays),), twinray.HIT)

def seen(array):  # as CuPy does
    told = array.__cuda_array_interface__
    size = told["strides"][0] * told["shape"][0]
    memory = (ctypes.c_uint8 * size).from_address(told["data"][0])
    return np.ndarray(told["shape"], told["typestr"] if len(array.dtype) == 0 else array.dtype, memory,
                      strides=told["strides"])

seen(shared)[:] = rays
scene.trace(shared, hits)
test.check(seen(hits), scene, rays)
assert (seen(hits["t_hit"])[:-1] == hits.numpy()["t_hit"][:-1]).all()
cuda = ctypes.CDLL("libcuda.so.1")
assert cuda.fake_imports() == 2 and cuda.fake_waits() == 1 and cuda.fake_depth() == 0
try:
    np.asarray(hits)
except BufferError as error:
    assert "GPU's memory" in str(error)
else:
    raise AssertionError("a silent copy")
del shared, hits, memories
import gc; gc.collect()
assert cuda.fake_imports() == 0, cuda.fake_imports()
"""


def run_with_cuda(tmp_path, uuid):
    here = str(Path(__file__).parent)
    package = str(Path(twinray.__file__).parents[1])
    environment = {
        "LD_LIBRARY_PATH": f"{fake_cuda(tmp_path).parent}:{os.environ.get('LD_LIBRARY_PATH', '')}",
        "PYTHONPATH": f"{package}:{here}",
        "FAKE_CUDA_UUID": uuid,
        "PYTHONWARNINGS": "ignore",
    }
    return run_python(WITH_CUDA, **environment)


def exported_memory():
    try:
        return twinray._core.DeviceMemory(scene_and_rays()[0]._core, 64, False)
    except twinray.Error as error:
        pytest.skip(str(error))


def test_cuda_sees_exported_memory(tmp_path):
    memory = exported_memory()
    result = run_with_cuda(tmp_path, memory.device_uuid().hex())
    assert result.returncode == 0, result.stderr
    other = run_with_cuda(tmp_path, "00" * 16)
    assert "BufferError: none of the 1 CUDA devices is the scene's device" in other.stderr


def test_without_cuda_it_says_so(tmp_path):
    try:
        ctypes.CDLL("libcuda.so.1")
    except OSError:
        pass
    else:
        pytest.skip("CUDA is there")
    array = twinray.DeviceArray(exported_memory(), (16,), np.dtype(np.float32))
    with pytest.raises(BufferError, match="CUDA's driver cannot be loaded"):
        array.__cuda_array_interface__  # noqa: B018


# PyTorch and CuPy see a GPU's memory by CUDA, where such a GPU, and one of them, is there.


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
