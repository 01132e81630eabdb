"""The packages that python_rays.py measures, in one way: build, load rays into the device's memory, trace."""

import pathlib
import subprocess
import tempfile

import numpy as np


class Twinray:
    def __init__(self, accel, has_cuda):
        import twinray

        self.scene = twinray.Scene(accel)
        backend = self.scene.backend
        self.about = f"{twinray.__version__}, {backend['path']} on {backend['device']}"
        self.moves = np.asarray
        if has_cuda:
            import cupy

            self.moves = cupy.asarray

    def build(self, vertices, triangles, offsets):
        first = self.scene.add_triangles(vertices, triangles, transform=moved(offsets[0]))
        for offset in offsets[1:]:
            self.scene.add_instance(first, moved(offset))

    def load(self, rays):
        import twinray

        self.rays = self.scene.device_array((len(rays), 8))
        whole = np.zeros((len(rays), 8), np.float32)
        whole[:, :3], whole[:, 4:7], whole[:, 7] = rays[:, :3], rays[:, 3:], np.inf
        self.moves(self.rays)[:] = self.moves(whole)
        self.hits = self.scene.device_array(len(rays), twinray.HIT)

    def trace(self, is_any):
        self.scene.trace(self.rays, self.hits, any_hit=is_any)

    def distances(self):
        return self.hits.numpy()["t_hit"]


class Baked:
    """Packages without instances get all triangles."""

    def build(self, vertices, triangles, offsets):
        n = np.arange(len(offsets))[:, None, None] * len(vertices)
        self.push((vertices[None] + offsets[:, None]).reshape(-1, 3), (triangles[None] + n).reshape(-1, 3))


class Embreex(Baked):
    def __init__(self):
        import embreex

        self.about = f"embreex {embreex.__version__}, robust, rays one by one"

    def push(self, vertices, triangles):
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.scene = EmbreeScene(robust=True)
        self.mesh = TriangleMesh(self.scene, vertices.astype(np.float32), triangles.astype(np.int32))

    def load(self, rays):
        self.origins, self.directions = np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 3:])

    def trace(self, is_any):
        self.found = self.scene.run(self.origins, self.directions, query="OCCLUDED" if is_any else "DISTANCE")

    def distances(self):
        return self.found


class Open3d(Baked):
    def __init__(self):
        import open3d

        self.o3d, self.about = open3d, open3d.__version__

    def push(self, vertices, triangles):
        self.scene = self.o3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.o3d.core.Tensor(vertices), self.o3d.core.Tensor(triangles.astype(np.uint32)))

    def load(self, rays):
        self.rays = self.o3d.core.Tensor(rays)

    def trace(self, is_any):
        self.found = self.scene.test_occlusions(self.rays) if is_any else self.scene.cast_rays(self.rays)["t_hit"]

    def distances(self):
        return self.found.numpy()


class Warp(Baked):
    def __init__(self, has_cuda):
        import warp

        warp.config.quiet = True
        self.wp, self.device = warp, "cuda" if has_cuda else "cpu"
        self.about = f"{warp.__version__}, {warp.get_device(self.device).name}"
        import warp_rays  # a kernel wants a file

        self.kernel = warp_rays.trace

    def push(self, vertices, triangles):
        self.mesh = self.wp.Mesh(
            self.wp.array(vertices, dtype=self.wp.vec3, device=self.device),
            self.wp.array(triangles.reshape(-1).astype(np.int32), dtype=int, device=self.device),
        )

    def load(self, rays):
        self.rays = [
            self.wp.array(np.ascontiguousarray(part), dtype=self.wp.vec3, device=self.device)
            for part in (rays[:, :3], rays[:, 3:])
        ]
        self.found = self.wp.zeros(len(rays), dtype=float, device=self.device)

    def trace(self, is_any):
        inputs = [self.mesh.id, *self.rays, is_any, self.found]
        self.wp.launch(self.kernel, len(self.found), inputs, device=self.device)
        self.wp.synchronize_device(self.device)

    def distances(self):
        return self.found.numpy()


class Mitsuba(Baked):
    def __init__(self, has_cuda):
        import mitsuba

        mitsuba.set_variant("cuda_ad_rgb" if has_cuda else "llvm_ad_rgb")
        import drjit

        self.mi, self.dr = mitsuba, drjit
        self.about = f"{mitsuba.__version__}, {'OptiX' if has_cuda else 'Embree, by LLVM'}"

    def push(self, vertices, triangles):
        mesh = self.mi.Mesh("mesh", len(vertices), len(triangles))
        values = self.mi.traverse(mesh)
        values["vertex_positions"] = vertices.reshape(-1)
        values["faces"] = triangles.reshape(-1)
        values.update()
        self.scene = self.mi.load_dict({"type": "scene", "mesh": mesh})

    def load(self, rays):
        origins, directions = (self.mi.Point3f(np.ascontiguousarray(part.T)) for part in (rays[:, :3], rays[:, 3:]))
        self.rays = self.mi.Ray3f(origins, self.mi.Vector3f(directions))
        self.dr.eval(self.rays)
        self.dr.sync_thread()

    def trace(self, is_any):
        self.found = self.scene.ray_test(self.rays) if is_any else self.scene.ray_intersect_preliminary(self.rays).t
        self.dr.eval(self.found)
        self.dr.sync_thread()

    def distances(self):
        return np.array(self.found)


class Program(Baked):
    """Made by programs.sh. It reads a mesh and rays, prints a line of seconds, and writes distances."""

    def __init__(self, folder, name):
        self.program = pathlib.Path(folder or "", name).resolve()
        if not folder or not self.program.is_file():
            raise FileNotFoundError("programs.sh has not made it")
        self.about = (self.program.parent / f"{name}.about").read_text().strip()
        self.files = tempfile.TemporaryDirectory()
        self.at = pathlib.Path(self.files.name)

    def push(self, vertices, triangles):
        vertices.astype(np.float32).tofile(self.at / "vertices")
        triangles.astype(np.int32).tofile(self.at / "triangles")

    def load(self, rays):
        rays.astype(np.float32).tofile(self.at / "rays")

    def trace(self, is_any):
        """The seconds that it says: not those of reading files and building."""
        done = subprocess.run(
            [self.program, "any" if is_any else "closest"], cwd=self.at, capture_output=True, text=True
        )
        if done.returncode:
            raise RuntimeError(done.stderr)
        return float(done.stdout.split()[-1])

    def distances(self):
        return np.fromfile(self.at / "distances", np.float32)


def moved(offset):
    return np.hstack([np.eye(3), np.reshape(offset, (3, 1))])


def backends_of(options):
    return {
        "twinray sw": lambda: Twinray("sw", options.cuda),
        "twinray hw": lambda: Twinray("hw", options.cuda),
        "embreex": Embreex,
        "open3d": Open3d,
        "warp": lambda: Warp(options.cuda),
        "mitsuba": lambda: Mitsuba(options.cuda),
        "cuBQL": lambda: Program(options.programs, "cubql_rays"),
        "deepeeRT": lambda: Program(options.programs, "deepee_rays"),
    }
