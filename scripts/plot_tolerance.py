#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plots patches against error: docs/images/tolerance.png from docs/results/tolerance.md.

    scripts/plot_tolerance.py [TABLE.md] [PICTURE.png]

One curve a model: the proven bound of each run over the number of its patches. Needs matplotlib
(scripts/install_dependencies.sh --render).
"""

import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent


def read_runs(path):
    """Per model: patches and bound in percent of every run, as the table has them."""
    runs, columns = defaultdict(list), None
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[0] == "model":
            columns = {name: k for k, name in enumerate(cells)}
        elif columns and line.startswith("|") and not set(line) <= set("|-: "):
            if cells[columns["patches"]]:
                runs[cells[0]].append((int(cells[columns["patches"]]), float(cells[columns["bound %"]])))
    return runs


def main():
    table = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/results/tolerance.md"
    picture = Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT / "docs/images/tolerance.png"
    figure, axes = plt.subplots(figsize=(8.0, 5.5))
    axes.set_prop_cycle(color=plt.get_cmap("tab20").colors)
    markers = "osD^v<>PX*hd"
    for marker, (model, points) in zip(markers * 4, sorted(read_runs(table).items())):
        x, y = zip(*sorted(points))
        axes.loglog(x, y, marker=marker, markersize=5, linewidth=1, label=model)
    axes.set_xlabel("patches")
    axes.set_ylabel("proven two-sided distance, % of the diagonal")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    return 0


if __name__ == "__main__":
    sys.exit(main())
