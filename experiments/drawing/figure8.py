"""Figure 8: the moment of f_thigmo (Eq. 8) about X, Y and Z over time and joint number while the knot slides, and a
page that tests the paper's three claims about it. Forces are means from one frame of the log to the
next (by default 20 ms); nothing else is filtered.

Usage: figure8.py LOG.h5 OUT_SURFACE.png OUT_CLAIMS.png (writes PDFs beside, and OUT_CLAIMS.json).
"""

import json
import textwrap
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import claims
import plots
from hagfish_log import HagfishLog
from script import run_script, whole

NAMES = {"X": "X (twist)", "Y": "Y (bend)", "Z": "Z (bend)"}
COLOURS = {"X": plots.BLUE, "Y": plots.ORANGE, "Z": plots.INK}
LETTERS = ("a", "b, c", "e", "d")  # panels of the page that show each claim


def surfaces(s: claims.Sliding, out: Path) -> None:
    """Three surfaces, and the same data from above with the knot's two ends."""
    figure = plt.figure(figsize=(10.5, 6.5))
    scale = np.percentile(np.abs(s.force[s.force != 0]), 99) if np.any(s.force) else 1.0
    per_joint = 2 * s.spacing  # cm of body to a joint number
    solids, flats = [], []
    for column, axis in enumerate(claims.KINDS):
        joint, force = s.axis(axis)
        axes = figure.add_axes([0.325 * column - 0.005, 0.42, 0.30, 0.56], projection="3d")
        grid_joint, grid_time = np.meshgrid(joint, s.time)
        axes.plot_surface(grid_joint, grid_time, force, rstride=1, cstride=1, cmap="RdBu_r", vmin=-scale, vmax=scale,
                          linewidth=0, antialiased=False, rasterized=True)
        axes.patch.set_visible(False)  # it would hide the tick labels of the panel before
        axes.view_init(elev=28, azim=-52)
        axes.set_xlabel("joint (head 0)", fontsize=8, labelpad=-3)
        axes.set_ylabel("time, s", fontsize=8, labelpad=-3)
        axes.tick_params(labelsize=7, pad=-2)
        axes.tick_params(axis="z", pad=3)
        solids.append(axes)

        flat = figure.add_axes([0.055 + 0.312 * column, 0.135, 0.255, 0.24])
        flat.grid(visible=False)
        image = flat.pcolormesh(joint.astype(float), s.time, force, cmap="RdBu_r", vmin=-scale, vmax=scale, shading="nearest", rasterized=True)
        flat.plot(s.head_end / per_joint, s.time, color="black", lw=0.9, label="head end")
        flat.plot(s.tail_end / per_joint, s.time, color="black", lw=0.9, ls="--", label="tail end")
        flat.set_xlabel("joint (head 0)", fontsize=8)
        flat.set_xlim(-0.5, s.joint.max() / 2 + 0.5)
        flat.tick_params(labelsize=7)
        flats.append(flat)
        if column == 0:
            flat.set_ylabel("time, s", fontsize=8)
            flat.legend(loc="upper right", fontsize=7, title="knot", title_fontsize=7, handlelength=1.4)
    plots.name_panels([*solids, *flats], [f"about {NAMES[axis]}, dyn cm" for axis in claims.KINDS]
                      + [f"{NAMES[axis]}, from above" for axis in claims.KINDS])
    bar = figure.add_axes([0.945, 0.135, 0.010, 0.24])
    bar.grid(visible=False)
    figure.colorbar(image, cax=bar, extend="both")
    bar.tick_params(labelsize=6.5, pad=1)
    bar.set_title("dyn cm", fontsize=7)
    figure.text(0.055, 0.015, r"Moment of $f_\mathrm{thigmo}=C_\mathrm{thigmo}^\top\lambda_\mathrm{thigmo}/h$ at each joint, in axes halfway through it, "
                f"while the knot slides: means over {1000 * s.interval:.0f} ms, from frame to frame of the log. The largest is "
                f"{np.abs(s.force).max():.0f} dyn cm.\nColours saturate at the 99th percentile of the non-zero magnitudes, "
                f"{scale:.0f} dyn cm.", fontsize=7.5)
    plots.save(figure, out)


def draw_zero(axes: Any, s: claims.Sliding) -> None:
    """Claim (a): where the force is not zero."""
    arcs = np.unique(s.arc)
    size = np.stack([np.abs(s.step_force[:, s.arc == arc]).max(axis=1) for arc in arcs], axis=1)
    top = max(size.max(), 1e-300)
    shown = np.ma.masked_where(size == 0, size)
    axes.grid(visible=False)
    image = axes.pcolormesh(arcs, s.time, shown, cmap="cividis", shading="nearest", rasterized=True, norm=LogNorm(vmin=top * 1e-4, vmax=top))
    axes.plot(s.head_end, s.time, color=plots.VERMILION, lw=1.2, label="knot, head end")
    axes.plot(s.tail_end, s.time, color=plots.VERMILION, lw=1.2, ls="--", label="knot, tail end")
    axes.set(xlabel="arc length from the head, cm", ylabel="time, s")
    axes.legend(loc="upper right")
    bar = axes.figure.colorbar(image, ax=axes, extend="min", pad=0.02, fraction=0.04)
    bar.ax.set_title("dyn cm", fontsize=7)


def draw_growth(axes: Any, s: claims.Sliding, name: str, found: dict[str, float]) -> None:
    """Claim (b): one measure of size against the knot's head end."""
    y = claims.measures(s)[name]
    axes.plot(s.head_end, y, ".", ms=3, color=plots.BLUE, label=f"means; Spearman {found['spearman_with_head_end']:+.2f}")
    x = np.array([np.nanmin(s.head_end), np.nanmax(s.head_end)])
    axes.plot(x, found["fit_slope_per_cm"] * x + found["fit_intercept"], color=plots.INK, lw=1,
              label=f"line: {found['fit_slope_per_cm']:+.3g} per cm, $R^2$ = {found['fit_r2']:.2f}")
    bounds = np.linspace(*x, 11)
    part = np.clip(np.digitize(s.head_end, bounds) - 1, 0, 9)
    medians = [np.median(y[part == k]) if np.any(part == k) else np.nan for k in range(10)]
    axes.stairs(medians, bounds, baseline=None, color=plots.VERMILION, lw=1.3, label="median of each tenth of the way")
    axes.invert_xaxis()
    axes.set(xlabel="knot head end, cm (the head is on the right)", ylabel=name)
    axes.set_ylim(0, 1.3 * axes.get_ylim()[1])  # room for the legend
    axes.legend(fontsize=7, loc="upper right")


def draw_modes(axes: Any, c: dict[str, Any]) -> None:
    """Claim (c): energy that a basis of k modes leaves out."""
    for basis, style in (("dct", "-"), ("svd", ":")):
        for axis, own in c["axes"].items():
            held = np.array(own[f"{basis}_held"])
            axes.semilogy(np.arange(1, len(held) + 1), np.maximum(1 - held, 1e-6), style, color=COLOURS[axis], lw=1.3,
                          label=f"{axis}, {'Fourier (DCT)' if basis == 'dct' else 'SVD'}")
    for share in claims.SHARES:
        axes.axhline(1 - share, color=plots.GREY, lw=0.6)
        axes.annotate(f"{share * 100:.0f} % held", (0.99, 1 - share), xycoords=("axes fraction", "data"), fontsize=6.5,
                      ha="right", va="bottom", color=plots.GREY)
    axes.set(xlabel="modes kept", ylabel="share of energy left out", ylim=(1e-4, 1.6))
    axes.legend(fontsize=6.5, ncol=2, loc="upper right", columnspacing=1.0)


def draw_roughness(axes: Any, c: dict[str, Any]) -> None:
    """Claim (c): roughness along the body and in time."""
    for shift, (name, look) in zip((-0.2, 0.2), plots.ROUGHNESS.items()):
        bars = axes.bar(np.arange(3) + shift, [own[f"roughness_in_{name}"] for own in c["axes"].values()], 0.38, color=look.colour,
                        label=look.label)
        axes.bar_label(bars, fmt="%.3f", fontsize=7)
    axes.set_xticks(range(3), [NAMES[axis] for axis in c["axes"]])
    axes.set_ylabel("roughness (1: white noise)")
    axes.grid(axis="x", visible=False)
    axes.margins(y=0.3)
    axes.legend(ncol=2, loc="upper left")


def plain_words(a: dict[str, Any], b: dict[str, Any], c: dict[str, Any]) -> list[tuple[str, str]]:
    """For each claim its name and what was found, with the rule of its verdict."""
    if a["nonzero_behind_tail_end"]:
        behind = (f"{a['nonzero_behind_tail_end']} of {a['values_behind_tail_end']} values tailward of the last "
                  f"contact are not 0 (largest {a['largest_behind_tail_end_dyn_cm']:.3g} dyn cm; furthest "
                  f"{a['furthest_nonzero_past_tail_end_cm']:.2f} cm past it)")
    else:
        behind = f"all {a['values_behind_tail_end']} values tailward of the last contact are exactly 0"
    zero = (f"of {a['steps']} single steps at frames, {behind}. Beyond the {claims.SPLINE_REACH} bodies that the spline adds to a row: "
            f"{a['nonzero_beyond_reach_of_rows']} of {a['values_beyond_reach_of_rows']} not 0. Largest force, a mean over "
            f"{1000 * c['mean_over_s']:.0f} ms: {a['largest_force_dyn_cm']:.4g} dyn cm; {100 * a['share_of_plane_zero']:.0f} % "
            "of all values are 0. Rule: exactly 0 beyond the rows' reach.")
    rows = [f"{name.split(',')[0]} ×{m['near_over_far']:.2f} (Spearman {m['spearman_with_head_end']:+.2f})" for name, m in b["measures"].items()]
    growth = ("mean over the third of the way nearest the head, over that of the furthest third: " + "; ".join(rows)
              + f". Rule: the first is at least {claims.LARGER}; at most 1 disagrees.")
    each = c["axes"].items()
    rough = ("; ".join(f"{axis}: {own['roughness_in_space']:.3f} along the body, {own['roughness_in_time']:.3f} in time"
                       for axis, own in each)
             + f", of means over {1000 * c['mean_over_s']:.0f} ms. The four multipliers in time: "
             f"{c['multipliers_roughness_in_time']:.3f} from mean to mean, "
             f"{c['multipliers_roughness_in_time_every_step']:.3f} from step to step. Rule: on each axis at most "
             f"{claims.SMOOTH} along the body, and at most half of that in time; on none of them disagrees.")
    modes = ("; ".join(f"{axis}: Fourier {own['dct_modes_95']} / {own['dct_modes_99']}, SVD {own['svd_modes_95']} / "
                       f"{own['svd_modes_99']} of {own['joints']}" for axis, own in each)
             + " modes hold 95 / 99 % of the energy of these means. Rule: 95 % in a quarter of the Fourier modes on each axis.")
    return list(zip(claims.verdicts(a, b, c), (zero, growth, rough, modes)))


def claims_page(s: claims.Sliding, out: Path) -> None:
    a, b, c = claims.zero_behind(s), claims.larger_near_head(s), claims.smooth_in_space(s)
    verdict = claims.verdicts(a, b, c)
    words = plain_words(a, b, c)
    figure = plt.figure(figsize=(8.3, 11.2))
    grid = figure.add_gridspec(3, 2, left=0.09, right=0.97, top=0.945, bottom=0.30, hspace=0.36, wspace=0.26)
    figure.text(0.04, 0.98, "Three claims about $f_\\mathrm{thigmo}$ while the knot slides. Forces f are means over "
                f"{1000 * s.interval:.0f} ms; (a) is of single steps.")
    zero, modes, rough = (figure.add_subplot(grid[place]) for place in ((0, slice(None)), (2, 0), (2, 1)))
    growth = [figure.add_subplot(grid[1, column]) for column in range(2)]
    draw_zero(zero, s)
    shown = list(b["measures"])[:2]
    for axes, name in zip(growth, shown):
        draw_growth(axes, s, name, b["measures"][name])
    draw_modes(modes, c)
    draw_roughness(rough, c)
    plots.name_panels([zero, *growth, modes, rough], ["largest |f| at each joint, single steps at frames; white: exactly 0",
                                                      *(name.split(",")[0] for name in shown), "modes along the body",
                                                      "neighbouring means compared"])
    height = 0.24
    for (name, text), letters in zip(words, LETTERS):
        figure.text(0.04, height, f"{name} ({letters}):", weight="bold")
        figure.text(0.96, height, verdict[name].upper(), weight="bold", ha="right", color=plots.VERDICTS[verdict[name]].colour)
        for line in textwrap.wrap(text, 138):
            height -= 0.0145
            figure.text(0.04, height, line, fontsize=7.5)
        height -= 0.022
    plots.save(figure, out)
    report = {"verdicts": verdict, "in_words": dict(words), "zero_behind_the_knot": a, "larger_near_the_head": b, "smooth_in_space": c}
    with whole(out.with_suffix(".json")) as part:
        part.write_text(json.dumps(report, indent=1) + "\n")
    for name, text in words:
        print(f"{name}: {verdict[name]}. {text}")


def main(path: Path, out_surface: Path, out_claims: Path) -> None:
    s = claims.read_sliding(HagfishLog(path))
    surfaces(s, out_surface)
    claims_page(s, out_claims)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT_SURFACE.png", "OUT_CLAIMS.png"], main)
