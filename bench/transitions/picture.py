"""The picture of a comparison: two domain angles, the map's nodes, and all paths."""

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np


def draw(file, names, nodes, energies, paths, others, ends):
    """Writes an SVG file.

    `names` are those of the two angles; everything else comes as pairs of arrays of them, degrees: `nodes`, coloured by `energies`,
    model kJ/mol above the least; `paths`, a list; `others`, a list of label, colour and pair; `ends`, a list of label and pair.
    """
    # The same picture gives the same bytes; text stays text.
    plt.rcParams.update({"svg.hashsalt": "roadmill", "svg.fonttype": "none", "font.size": 9})
    figure, axes = plt.subplots(figsize=(7.2, 6.2), layout="constrained")
    # Low nodes above high ones, which are more. Dots are drawn as one bitmap: an SVG of as many circles would take megabytes.
    order = np.argsort(-energies)
    low, high = np.percentile(energies, [0, 95])
    dots = axes.scatter(
        *nodes[:, order],
        c=energies[order] - low,
        s=4,
        lw=0,
        cmap="Greys_r",
        vmin=-0.7 * (high - low),
        vmax=1.4 * (high - low),
        rasterized=True,
    )
    bar = figure.colorbar(
        dots, ax=axes, fraction=0.03, pad=0.01, label="energy of a node above the lowest, model kJ/mol"
    )
    bar.ax.set_ylim(0, high - low)
    for k, (x, y) in enumerate(paths):
        colour = plt.cm.viridis(0.1 + 0.8 * k / max(1, len(paths) - 1))
        axes.plot(x, y, lw=1.1, marker=".", ms=3, color=colour, label=f"roadmill, path {k + 1}")
    for label, colour, (x, y) in others:
        axes.plot(x, y, lw=1.1, marker=".", ms=3, color=colour, label=label)
    for (label, (x, y)), shift in zip(ends, ((8, 8), (10, -12))):
        axes.plot(x, y, "*", ms=13, mfc="white", mec="black", zorder=5)
        box = {"fc": "white", "ec": "none", "pad": 1, "alpha": 0.8}
        axes.annotate(label, (x, y), xytext=shift, textcoords="offset points", zorder=6, bbox=box)
    axes.set_xlabel(f"{names[0]} angle, degrees")
    axes.set_ylabel(f"{names[1]} angle, degrees")
    figure.legend(loc="outside lower center", ncols=3, fontsize=8)
    figure.savefig(file, dpi=96, metadata={"Date": None})
