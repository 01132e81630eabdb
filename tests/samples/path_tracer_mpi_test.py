#!/usr/bin/env python3
"""Runs `path_tracer` under mpirun. Usage: path_tracer_mpi_test.py PATH_TRACER [MPIRUN]; skipped (77) without MPIRUN"""
import os
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from command import here, program as path_tracer, rank_of, same

if len(sys.argv) < 3:
    print("built without MPI")
    sys.exit(77)
mpirun = sys.argv[2]
box = ["builtin:cornell-box", "--height", "16", "--accel", "sw", "-o"]


def start(ranks, *arguments):
    return subprocess.Popen([mpirun, "-n", str(ranks), "--oversubscribe", path_tracer, *box, *arguments],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=here)


def run(ranks, *arguments, status=0):
    process = start(ranks, *arguments)
    shown = process.communicate()[0]
    assert process.returncode == status, f"{arguments}: status {process.returncode}\n{shown}"
    return shown


# Two processes give the result of one, with each sample once.
assert "9 spp" in run(1, "one.png", "--spp", "9", "--keep-film")
assert "9 spp" in run(2, "two.png", "--spp", "9", "--keep-film")
for suffix in ["png", "png.film"]:
    assert same(f"one.{suffix}", f"two.{suffix}"), suffix
assert "under mpirun" in run(2, "no.png", "--target-error", "0.1", status=1)
assert len(list(here.iterdir())) == 4, list(here.iterdir())

# When a rank is lost, the samples so far are kept, and resumed.
process = start(2, "lost.png", "--spp", "4000", "--checkpoint", "0")
films = [here / f"lost.png.rank{rank}of2.film" for rank in range(2)]
while process.poll() is None and not all(film.exists() for film in films):
    time.sleep(0.01)
os.kill(rank_of(process, 1), signal.SIGKILL)
shown = process.communicate()[0]
assert process.returncode != 0 and "rank 1" in shown and all(film.exists() for film in films), shown
done = subprocess.run([path_tracer, "merge", *films, "-o", "saved.png"], capture_output=True, text=True, cwd=here)
assert done.returncode == 0, done.stderr
samples = int(done.stdout.split(", ")[1].split()[0])
assert "resumed" in run(2, "lost.png", "--spp", str(samples + 20), "--resume")
assert not any(film.exists() for film in films), "nothing is left behind"
print("path_tracer_mpi_test: passed")
