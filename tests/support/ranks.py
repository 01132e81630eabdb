# SPDX-License-Identifier: MIT
"""Ranks that mpirun starts, which may be run by root."""
import os
import pathlib

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


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
