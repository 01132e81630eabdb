#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the plots of a twinray report with matplotlib. Usage: draw_plots.py FOLDER; reads FOLDER/plots.json, writes
FOLDER/plots/*.svg and *.png and prints how many. Exits with 3 where matplotlib is missing (Debian: python3-matplotlib)."""
import json
import pathlib
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(3)
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8c6d00"]


def bars(points, value, interval):
    """Distances to the ends of the intervals, as errorbar wants them."""
    return [[max(p[value] - p[interval][0], 0) for p in points], [max(p[interval][1] - p[value], 0) for p in points]]


def draw_curve(axes, curve):
    color, marker = COLORS[curve["style"] % len(COLORS)], "os^D"[curve["style"] % 4]
    seen = [p for p in curve["points"] if not p["is_zero"]]
    zeros = [p for p in curve["points"] if p["is_zero"]]
    label, fit = curve["name"], curve["fit"]
    if fit:
        label += "\nslope {:.2f} [{:.2f}, {:.2f}]".format(fit["slope"], *fit["slope_95"])
        ends = [seen[0]["error"], seen[-1]["error"]]
        axes.plot(ends, [fit["scale"] * x ** fit["slope"] for x in ends], "--", color=color, alpha=0.7)
    if seen:
        axes.errorbar([p["error"] for p in seen], [p["time"] for p in seen], xerr=bars(seen, "error", "error_95"),
                      yerr=bars(seen, "time", "time_95"), fmt=marker, color=color, capsize=2, elinewidth=0.8,
                      label=label)
    if zeros:  # the truth lies anywhere to the left of the bound
        axes.errorbar([p["error"] for p in zeros], [p["time"] for p in zeros],
                      xerr=[[0.45 * p["error"] for p in zeros], [0.0] * len(zeros)], xuplims=True,
                      yerr=bars(zeros, "time", "time_95"), fmt=marker, color=color, mfc="white", elinewidth=0.8,
                      label=None if seen else label)


def draw(plot, folder):
    figure, axes = plt.subplots(figsize=(8.5, 4.8), layout="constrained")
    axes.set(xscale="log", yscale="log", xlabel=plot["error_label"], ylabel=plot["time_label"], title=plot["title"])
    axes.grid(True, which="major", color="#dddddd")
    if plot["floor"] is not None:
        axes.axvline(plot["floor"], color="#777777", linestyle=":", label="floor: rounding")
    for curve in plot["curves"]:
        draw_curve(axes, curve)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize="small", frameon=False)
    for suffix in ("svg", "png"):
        figure.savefig(folder / f"{plot['id']}.{suffix}", dpi=130)
    plt.close(figure)


report = pathlib.Path(sys.argv[1])
plots = json.loads((report / "plots.json").read_text(encoding="utf-8"))
(report / "plots").mkdir(exist_ok=True)
for one in plots:
    draw(one, report / "plots")
print(len(plots))
