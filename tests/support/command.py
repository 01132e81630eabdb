"""A program as a user runs it: the one that a test's first argument names, in a folder of the test's own."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
program, here = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(tempfile.mkdtemp())


def run(*arguments, status=0, env=None, of=program, one_stream=False):
    """What it prints, with these variables beside those of the environment; it must end with this status, and without
    a message of the validation layer. one_stream: only what it prints to stdout if the status is 0, else to stderr."""
    done = subprocess.run([of, *map(str, arguments)], capture_output=True, text=True, cwd=here,
                          env=os.environ | (env or {}))
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}{done.stderr}"
    assert "VUID" not in done.stderr and "SYNC-HAZARD" not in done.stderr, done.stderr
    if one_stream:
        return done.stderr if status else done.stdout
    return done.stdout + done.stderr


def expect_refusals(cases, *before):
    """Each case: the arguments that follow those before, the status, and words of what is said."""
    for arguments, status, words in cases:
        said = run(*before, *arguments, status=status)
        assert words in said, f"{arguments}: {said}"


def records(name):
    """The records of a file, one a line, in JSON."""
    return [json.loads(line) for line in (here / name).read_text().splitlines()]


def same(*names):
    """Whether the files have the same bytes."""
    return len({(here / name).read_bytes() for name in names}) == 1


def write_ply(name, points, faces, number="float"):
    """Points: rows of three numbers, or texts of them."""
    rows = [point if isinstance(point, str) else " ".join(map(str, point)) for point in points]
    rows += [f"{len(face)} {' '.join(map(str, face))}" for face in faces]
    axes = "".join(f"property {number} {axis}\n" for axis in "xyz")
    (here / name).write_text(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n{axes}element face {len(faces)}\n"
                             "property list uchar int vertex_indices\nend_header\n" + "\n".join(rows) + "\n")


def rank_of(process, rank):
    """The number of the rank's process, a child of this one."""
    for child in pathlib.Path("/proc").iterdir():
        try:
            if child.name.isdigit() and (f"PPid:\t{process.pid}\n" in (child / "status").read_text()
                                         and f"OMPI_COMM_WORLD_RANK={rank}\0".encode()
                                         in (child / "environ").read_bytes()):
                return int(child.name)
        except OSError:
            pass
    raise AssertionError(f"there is no rank {rank}")
