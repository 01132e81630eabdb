#!/usr/bin/env python3
"""Runs `twinray bench` and the scripts that keep its history, as a user does. Usage: bench_command_test.py TWINRAY FOLDER,
the latter with the scripts."""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here, program as twinray, run

scripts = pathlib.Path(sys.argv[2])


def bench(*arguments, status=0):
    """What it prints, and its records."""
    (here / "records.jsonl").unlink(missing_ok=True)
    said = run("bench", "--quiet", "--json", "records.jsonl", *arguments, status=status)
    return said, command.records("records.jsonl") if (here / "records.jsonl").exists() else []


KINDS = ["primary", "incoherent", "occlusion"]
RATIOS = ["vs_ray_query", "vs_ray_query_presorted", "vs_pipeline", "vs_embree8", "vs_sw"]
FIELDS = {"schema", "device", "started", "git", "width", "seed", "scene", "origin", "triangles", "rays", "n", "rounds", "contestant",
          "backend", "path", "order", "layout", "builder", "level", "ray_order", "mrays_per_s", "mrays_per_s_min", "mrays_per_s_max",
          "build_ms", "build_ms_min", "build_ms_max", "build_wall_ms", "bytes_per_triangle", "scratch_bytes_per_triangle",
          "agreement", "faults", "judged", "hits_hash", *RATIOS}

# All contestants, on all rays.
said, records = bench("--validation", "--scene", "sphere:320", "--width", "32", "--rounds", "3")
names = sorted({r["contestant"] for r in records})
assert {"sw compressed4 watertight", "sw bvh2 watertight"} <= set(names)
assert sorted((r["rays"], r["contestant"]) for r in records) == sorted((k, n) for k in KINDS for n in names)
for r in records:
    assert set(r) == FIELDS, set(r) ^ FIELDS
    assert (r["schema"], r["scene"], r["triangles"], r["n"], r["rounds"]) == ("twinray-bench/1", "sphere:320", 320, 1024, 3)
    assert 0 < r["mrays_per_s_min"] <= r["mrays_per_s"] <= r["mrays_per_s_max"]
    assert 0 < r["build_ms_min"] <= r["build_ms"] <= r["build_ms_max"] and r["build_wall_ms"] > 0
    assert r["bytes_per_triangle"] > 0 and r["agreement"] > 0.98 and r["judged"] == 1024
    assert r["backend"] != "sw" or r["faults"] == 0
    assert f"{r['hits_hash']}" in said and r["contestant"] in said
for kind in KINDS:  # layouts give the same bits; a baseline compares with itself as 1
    of_kind = [r for r in records if r["rays"] == kind]
    assert len({r["hits_hash"] for r in of_kind if r["backend"] == "sw"}) == 1
    for ratio in RATIOS:
        values = [r[ratio] for r in of_kind]
        assert values == [None] * len(values) or 1 in values, (ratio, values)
assert all(r["vs_sw"] is not None for r in records)

# Some contestants, on some rays.
_, records = bench("--scene", "instances:4x80", "--width", "16", "--rounds", "1", "--ray-kinds", "occlusion", "--layouts", "bvh2",
                   "--levels", "fast,watertight", "--backends", "sw", "--no-build")
assert [(r["rays"], r["contestant"]) for r in records] == [("occlusion", "sw bvh2 fast"), ("occlusion", "sw bvh2 watertight")]
assert all(r["build_ms"] is None and r["vs_embree8"] is None and r["triangles"] == 320 for r in records)
_, records = bench("--scene", "soup:100", "--width", "16", "--rounds", "1", "--ray-kinds", "primary", "--no-embree",
                   "--backends", "compressed4,embree")
assert not any(r["backend"] == "embree" for r in records)

# Rays in random order, and the contestants that sort them.
said, records = bench("--scene", "sphere:320", "--width", "32", "--rounds", "1", "--ray-kinds", "incoherent,shuffled", "--layouts",
                      "bvh2", "--backends", "sw,embree8 low", "--ray-orders", "given,sorted", "--no-build")
ours = [r for r in records if r["backend"] == "sw"]
assert [(r["rays"], r["contestant"], r["ray_order"]) for r in ours] == [
    (kind, "sw bvh2 watertight" + suffix, order) for kind in ("incoherent", "shuffled")
    for suffix, order in (("", "given"), (" sorted", "sorted"))]
assert len({(r["rays"], r["hits_hash"]) for r in ours}) == 2, "hits depend on the order"
assert len({r["hits_hash"] for r in ours}) == 2, "shuffled rays are not"
assert all(r["ray_order"] == "" for r in records if r["backend"] == "embree")

# A contestant that is too slow traces whole tiles, evenly chosen, and has no hash.
_, records = bench("--scene", "sphere:80", "--width", "64", "--rounds", "1", "--backends", "compressed4", "--max-seconds",
                   "1e-9")
assert all(r["n"] == 4 * 64 and r["hits_hash"] is None and r["mrays_per_s"] > 0 for r in records)

# The growth of times.
said, records = bench("--growth", "80,320,1280", "--width", "16", "--rounds", "1", "--backends", "compressed4")
assert [r["scene"] for r in records[:-1:2]] == ["sphere:80", "sphere:320", "sphere:1280"]
growth = records[-1]
assert (growth["triangles_from"], growth["triangles_to"]) == (80, 1280) and " a doubling" in said
assert set(growth["growth"]) == {"build_ms", "primary_ns_per_ray", "incoherent_ns_per_ray"}
assert isinstance(growth["growth"]["build_ms"]["power"], float)
# Each step is two doublings of the triangles.
times = [1e3 / r["mrays_per_s"] for r in records[:-1] if r["rays"] == "primary"]
assert abs(growth["growth"]["primary_ns_per_ray"]["per_doubling"] - (times[2] - times[0]) / 4) < 1e-6 * max(times)

_, records = bench("--moves", "20", "--rounds", "1")
assert records and all(r["refit_ms"] > 0 and r["rebuild_ms"] > 0 for r in records)

# The cost of features: steps hold more and more features, and find the same hits.
said, records = bench("--validation", "--feature-costs", "--scene", "sphere:320", "--width", "16", "--rounds", "5", "--ray-kinds",
                      "incoherent,occlusion")
for kind in KINDS[1:]:
    steps = [r for r in records if r.get("rays") == kind]
    assert steps[0]["step"] == "needed" and len(steps) == (9 if kind == "occlusion" else 8)
    assert all(a["features"] & b["features"] == a["features"] for a, b in zip(steps, steps[1:]))
    assert len({r["hits_hash"] for r in steps}) == 1 and steps[0]["hits_hash"] in said
    assert all(r["ns_per_ray"] > 0 and r["rounds"] == 5 for r in steps) and steps[0]["of_needed"] == 1
# Configurations tell the memory that is kept: the least first, vertices only where they move or levels are refined,
# no layout in less.
kept = {r["configuration"]: r for r in records if "configuration" in r}
assert list(kept)[0] == "needed" and "bytes/triangle" in said and all(r["build_ms"] > 0 for r in kept.values())
assert kept["needed"]["total_bytes_per_triangle"] <= 1.01 * min(r["total_bytes_per_triangle"] for r in kept.values())
assert {name for name, r in kept.items() if r["vertices_bytes_per_triangle"] > 0} == {
    "vertices moved", "level refined", "level certified"}
assert kept["layout bvh2"]["structures_bytes_per_triangle"] > kept["needed"]["structures_bytes_per_triangle"]
host = {name: r["host_bytes_per_triangle"] for name, r in kept.items()}
assert host["needed"] < 1 and host["meshes on the host"] - host["needed"] > 18, host
_, records = bench("--feature-costs", "--no-build", "--scene", "instances:3x80", "--width", "16", "--layouts", "bvh2", "--ray-kinds",
                   "primary")
assert [r["step"] for r in records] == ["needed", "+ masks", "+ culling", "+ filters", "+ boxes", "+ other layouts"]

# Trees: counts of each layout and quality; a wider node is fetched less often.
said, records = bench("--trees", "--scene", "sphere:320", "--width", "16", "--ray-kinds", "primary")
trees = {(r["layout"], r["build_quality"]): r for r in records}
assert len(trees) == len(records) == 9 and "compressed8 ploc" in said
steps = {key: r["steps_per_ray"]["primary"] for key, r in trees.items()}
for quality in ("fast", "high", "ploc"):
    nodes = [steps[layout, quality]["nodes"] for layout in ("bvh2", "compressed4", "compressed8")]
    assert nodes[0] > nodes[1] > nodes[2] > 0, nodes
    assert steps["bvh2", quality]["boxes"] == 2 * nodes[0]
assert all(0 < r["used_bytes_per_triangle"] <= r["bytes_per_triangle"] and r["sah"] > 1 for r in records)
assert "--scene" in bench("--trees", status=2)[0]

# Errors are reported.
assert "'abc' is not a whole number" in bench("--scene", "sphere:abc", status=1)[0]
assert "no backend's name contains 'nobody'" in bench("--scene", "sphere:80", "--backends", "nobody", status=1)[0]
for wrong in (["--ray-kinds", "diffuse"], ["--ray-orders", "random"], ["--width", "12"], ["--max-seconds", "0"],
              ["--growth", "80"]):
    bench("--scene", "sphere:80", *wrong, status=2)
for wrong in (["--growth", "1"], ["--rounds", "1"], ["--feature-costs"]):
    bench(*wrong, status=2)

# History: each run is appended, and drawn where matplotlib is.
options = ["--", "--width", "16", "--rounds", "1", "--backends", "sw compressed4"]
for runs in (1, 2):
    run("-t", twinray, "-o", "history", "sphere:80", "soup:80", *options, of=scripts / "record_history.sh")
    (history,) = (here / "history").glob("*.jsonl")
    kept = command.records(history)
    assert len(kept) == runs * 2 * 3 and {r["scene"] for r in kept} == {"sphere:80", "soup:80"}
    assert all(r["started"] and r["git"] and r["device"]["driver"] for r in kept)
run("-t", twinray, "-o", "history", "sphere:80", "sphere:abc", *options, status=1, of=scripts / "record_history.sh")
assert len(history.read_text().splitlines()) == len(kept), "a run that failed was recorded"
run("--nonsense", status=2, of=scripts / "record_history.sh")
has_matplotlib = subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True).returncode == 0
for picture in ("plot.svg", "plot.png"):
    said = run(scripts / "plot_history.py", history, "-o", picture, status=0 if has_matplotlib else 1,
               of=sys.executable)
    assert (here / picture).exists() if has_matplotlib else "python3-matplotlib" in said, said
print("bench: the command and its history work")
