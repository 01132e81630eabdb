#!/usr/bin/env python3
"""Parts of a command's work: --shard, --merge, and ranks of mpirun. Usage: shards_command_test.py TWINRAY [MPIRUN],
without MPIRUN in a build without MPI."""
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from command import here, program as twinray, rank_of, run

mpirun = "".join(sys.argv[2:])
os.chdir(here)


def write_files():
    numbers, n = random.Random(1), 12
    vertices = [f"v {x} {y} {numbers.uniform(0, 0.7)}" for x in range(n) for y in range(n)]
    faces = []
    for corner in (x * n + y + 1 for x in range(n - 1) for y in range(n - 1)):
        faces += [f"f {corner} {corner + n} {corner + n + 1}", f"f {corner} {corner + n + 1} {corner + 1}"]
    rows = {"points.csv": "{},{},1", "rays.csv": "{} {} 5 0.1 0.3 -1", "sensors.pts": "{} {} 1 0 0.2 1"}
    for name, row in rows.items():
        lines = [row.format(numbers.uniform(0, 11), numbers.uniform(0, 11)) for _ in range(50)]
        pathlib.Path(name).write_text("\n".join(lines) + "\n")
    pathlib.Path("scene.obj").write_text("\n".join(vertices + faces) + "\n")
    corners = [f"v {x} {y} {z}" for x in (0, 9) for y in (0, 9) for z in (0, 2)]
    sides = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    pathlib.Path("box.obj").write_text("\n".join(corners + [f"f {side}" for side in sides]) + "\n")
    pathlib.Path("sun.csv").write_text("0.5,0,-1,2\n-0.5,0.3,-1,1\n")


def under_mpi(*words, **options):
    return run("--oversubscribe", "-n", 2, twinray, *words, of=mpirun, **options)


COMMANDS = [
    ("factors.npz", "--output", "viewfactors scene.obj --rays-per-row 256"),
    ("projected.csv", "--output", "viewfactors scene.obj --rays-per-row 256 --estimator hits --project"),
    ("seen.npz", "--output", "visible scene.obj --sensors sensors.pts --up 0 0 1"),
    ("lit.csv", "--output", "illumination scene.obj --direction 0.3 0 -1 --grid 101"),
    ("sky.csv", "--output", "illumination scene.obj --sky 32 --up 0 0 1"),
    ("hours.csv", "--output", "illumination scene.obj --sun sun.csv --samples 4"),
    ("near.npz", "--output", "distance box.obj --points points.csv --signed"),
    ("within.csv", "--output", "distance scene.obj --points points.csv --within 0.8"),
    ("hits.bin", "--hits", "trace scene.obj --rays rays.csv"),
    ("all.bin", "--hits", "trace scene.obj --rays rays.csv --query all --counts counts.bin"),
]


def check_parts(output, option, line):
    """Parts in any order, and ranks, give the bytes of one process."""
    output = pathlib.Path(output)
    words = [*line.split(), option, output, "--quiet"]

    def written():
        files = [output, *([pathlib.Path("counts.bin")] if "--counts" in words else [])]
        content = [file.read_bytes() for file in files]
        for file in files:
            file.unlink()
        return content

    run(*words)
    whole = written()
    for part in (2, 0, 1):
        run(*words, "--shard", f"{part}/3")
        assert not output.exists(), "a part alone is no result"
    run(*words, "--merge", "3")
    assert written() == whole, f"{line}: parts differ from the whole"
    parts = list(pathlib.Path().glob(f"{output}.shard*"))
    assert len(parts) == 3
    for part in parts:
        part.unlink()
    if mpirun:
        under_mpi(*words)
        assert written() == whole, f"{line}: ranks differ from one process"
        assert not list(pathlib.Path().glob(f"{output}.shard*")), "ranks leave no parts"


def check_refusals():
    line = ["visible", "scene.obj", "--sensors", "sensors.pts", "-o", "parts.csv", "--quiet"]
    run(*line, "--shard", "0/2")
    assert "'parts.csv.shard1of2' is missing: --shard 1/2 writes it" in run(*line, "--merge", "2", status=1)
    run(*line, "--shard", "1/2", "--t-near", "1")
    assert "has '--t-near: 0x1p+0', not '--t-near: 0x0p+0'" in run(*line, "--merge", "2", status=1)
    part = pathlib.Path("parts.csv.shard1of2")
    run(*line, "--shard", "1/2")
    whole = part.read_bytes()
    for damaged in (whole[:-5], whole[:-8] + bytes([whole[-8] ^ 1]) + whole[-7:], whole[:40], b"no shard", b""):
        part.write_bytes(damaged)
        assert "parts.csv.shard1of2'" in run(*line, "--merge", "2", status=1)
    assert not pathlib.Path("parts.csv").exists()
    for wrong in ("2/2", "0/0", "-1/2", "1", "1/2/3", "a/b"):
        assert "must be K/N" in run(*line, "--shard", wrong, status=2)
    assert "requires --output" in run(*line[:4], "--shard", "0/2", status=2)
    assert "excludes --json" in run(*line, "--shard", "0/2", "--json", "a.json", status=2)
    factors = ["viewfactors", "scene.obj", "-o", "other.npz", "--rays-per-row", "64", "--quiet"]
    for seed in (1, 2):
        run(*factors, "--shard", f"{seed - 1}/2", "--seed", seed)
    assert "rows of another scene or of other options" in run(*factors, "--merge", "2", status=1)
    file = pathlib.Path("other.npz.shard0of2")
    file.write_bytes(file.read_bytes()[:-9])
    assert "of 121 rows are finished; --resume goes on" in run(*factors, "--merge", "2", status=1)
    run(*factors, "--shard", "0/2", "--resume")
    run(*factors, "--shard", "1/2")
    run(*factors, "--merge", "2")


def check_lost_rank():
    """What a lost rank leaves is kept, and taken by the next run."""
    words = ["viewfactors", "scene.obj", "-o", "lost.npz", "--rays-per-row", "100000", "--estimator", "hits", "--quiet"]
    parts = [pathlib.Path(f"lost.npz.shard{rank}of2") for rank in (0, 1)]
    process = subprocess.Popen([mpirun, "--oversubscribe", "-n", "2", twinray, *words], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    while process.poll() is None and not all(part.exists() and part.stat().st_size > 2000 for part in parts):
        time.sleep(0.01)
    os.kill(rank_of(process, 1), signal.SIGKILL)
    assert process.wait() != 0 and all(part.stat().st_size > 2000 for part in parts)
    assert not pathlib.Path("lost.npz").exists()
    assert "resumed after" in under_mpi(*[word for word in words if word != "--quiet"], "--resume")
    found = pathlib.Path("lost.npz").read_bytes()
    run(*words)
    assert pathlib.Path("lost.npz").read_bytes() == found
    assert "under mpirun there is no --shard" in under_mpi(*words, "--shard", "0/2", status=2)


write_files()
for command in COMMANDS:
    check_parts(*command)
check_refusals()
if mpirun:
    check_lost_rank()
    libraries = subprocess.run(["ldd", twinray], capture_output=True, text=True).stdout
    assert "libmpi" not in libraries, "a program that no rank is would load it"
print("shards_command_test: passed" + ("" if mpirun else ", without MPI"))
