# SPDX-License-Identifier: MIT
"""A program as a user runs it: the one that a test's first argument names, in a folder of the test's own."""
import pathlib
import subprocess
import sys
import tempfile

program, here = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(tempfile.mkdtemp())


def run(*arguments, status=0, env=None):
    """What it prints; it must end with this status, and without a message of the validation layer."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=here, env=env)
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}{done.stderr}"
    assert "VUID" not in done.stderr and "SYNC-HAZARD" not in done.stderr, done.stderr
    return done.stdout + done.stderr
