#!/usr/bin/env python3
"""`path_tracer --denoise` with the library, without it and with another one in its place. It ends with 77, skipped,
after the last two if the library is not found. Usage: path_tracer_denoise_test.py PATH_TRACER"""
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here

LIBRARY = "libOpenImageDenoise.so.2"
box = ["builtin:cornell-box", "--height", "48", "--accel", "sw"]


def run(*arguments, status=0, folder=None):
    """folder: for libraries, instead of those that the environment names; "": none."""
    return command.run(*arguments, status=status, env=None if folder is None else {"LD_LIBRARY_PATH": str(folder)})


def is_found(folder):
    code = f"import ctypes; ctypes.CDLL('{LIBRARY}')"
    return subprocess.run([sys.executable, "-c", code], stderr=subprocess.DEVNULL,
                          env={**os.environ, "LD_LIBRARY_PATH": folder}).returncode == 0


folders = os.environ.get("LD_LIBRARY_PATH", "")
if not is_found(""):
    shown = run(*box, "-o", "none.png", "--denoise", status=1, folder="")
    assert shown.count("\n") == 1 and f"{LIBRARY} cannot be opened (the package pyoidn of PyPI has it" in shown, shown
    assert not (here / "none.png").exists()
(here / "other").mkdir()
standard = next(line.split()[-1] for line in open("/proc/self/maps") if "/libc.so" in line or "/libc-" in line)
(here / "other" / LIBRARY).symlink_to(standard)
shown = run(*box, "-o", "none.png", "--denoise", status=1, folder=here / "other")
assert f"{LIBRARY}: not Open Image Denoise 2, because it has no oidnNewDevice" in shown, shown
assert "must be a picture, .png or .exr" in run(*box, "-o", "none.film", "--denoise", status=1)
assert "--denoise excludes --cross-check" in run(*box, "-o", "none.png", "--denoise", "--cross-check", "x", status=2)

if not is_found(folders):
    print(f"{LIBRARY} is not found: what it does to pictures is not tested")
    sys.exit(77)

# The picture is nearer to a better one; the film keeps its noise.
run(*box, "--spp", "256", "--seed", "2", "-o", "better.exr")
run(*box, "--spp", "4", "-o", "noisy.exr", "--keep-film")
noisy = run(*box, "--resume", "--spp", "4", "-o", "noisy.exr", "--keep-film", "--mse-reference-image", "better.exr")
shown = run(*box, "--spp", "4", "-o", "smooth.exr", "--keep-film", "--aovs", "--denoise",
            "--mse-reference-image", "better.exr", "--json", "smooth.jsonl")
record = command.records("smooth.jsonl")[0]
assert "; with its noise: MSE" in shown and shown.split("with its noise: ")[1].strip() in noisy, (shown, noisy)
assert record["relative_mse"] < 0.2 * record["noisy_relative_mse"], record
assert b"albedo.R\0" in (here / "smooth.exr").read_bytes()[:1000]
assert command.same("smooth.exr.film", "noisy.exr.film")
# --resume denoises a film that was rendered without --denoise.
(here / "noisy.exr.film").rename(here / "later.exr.film")
shown = run(*box, "--resume", "--spp", "4", "-o", "later.exr", "--denoise", "--mse-reference-image", "smooth.exr")
assert "MSE 0, relMSE 0; with its noise" in shown, shown
