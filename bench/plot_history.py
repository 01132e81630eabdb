#!/usr/bin/env python3
"""Draws how rates and their ratios have changed: plot_history.py HISTORY.jsonl -o PICTURE.svg|.png. A row for each scene and
figure, a column for each set of rays, a line for each backend, a step to the right for each run."""
import argparse
import json
import sys

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("history", help="as bench/record_history.sh writes it")
parser.add_argument("-o", "--output", required=True, help=".svg or .png")
options = parser.parse_args()
try:
    import matplotlib
except ImportError:
    sys.exit("plot_history: matplotlib is missing (Debian: apt-get install python3-matplotlib)")
matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

FIGURES = {"mrays_per_s": "Mrays/s", "vs_ray_query_presorted": "times ray query, presorted", "vs_embree8": "times embree8"}

with open(options.history, encoding="utf-8") as lines:
    records = [record for record in map(json.loads, lines) if "mrays_per_s" in record]
if not records:
    sys.exit(f"plot_history: {options.history} has no record of a trace")
scenes, kinds, backends = (sorted({r[key] for r in records}) for key in ("scene", "rays", "contestant"))
rows = [(scene, figure) for scene in scenes for figure in FIGURES]
color = {name: matplotlib.colormaps["tab20"](i % 20) for i, name in enumerate(backends)}

drawing, grid = pyplot.subplots(len(rows), len(kinds), figsize=(5 * len(kinds), 2.6 * len(rows)), squeeze=False)
for axes_of_row, (scene, figure) in zip(grid, rows):
    of_scene = [r for r in records if r["scene"] == scene]
    runs = sorted({(r["started"], r["git"]) for r in of_scene})
    for axes, kind in zip(axes_of_row, kinds):
        for name in backends:
            points = sorted((runs.index((r["started"], r["git"])), r[figure]) for r in of_scene
                            if (r["rays"], r["contestant"]) == (kind, name) and r[figure] is not None)
            if points:
                axes.plot(*zip(*points), marker=".", color=color[name], label=name)
        axes.set(title=f"{scene}, {kind}", ylabel=FIGURES[figure], yscale="log")
        axes.set_xticks(range(len(runs)), [f"{started[:10]}\n{git.split()[-1]}" for started, git in runs], fontsize=6)
entries = {label: line for axes in grid.flat for line, label in zip(*axes.get_legend_handles_labels())}
drawing.legend(entries.values(), entries.keys(), loc="lower center", ncol=4)
drawing.tight_layout(rect=(0, 0.6 / len(rows), 1, 1))
drawing.savefig(options.output)
