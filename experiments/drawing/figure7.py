"""Figure 7: the run in at least eight pictures, from the straight animal to the freed one.

All panels share one camera and one scale. `hagfish picture` draws the animal.
Usage: figure7.py LOG.h5 HAGFISH OUT.png, where HAGFISH is the program (writes OUT.pdf beside).
"""

from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import plots
from hagfish_log import HagfishLog
from log_pictures import Picture, take_pictures
from script import run_script

DPI = 400
LEAST_PANELS = 8
GAP = 0.08  # around the animal in a panel, inches
LEAST_WIDTH = 1.5  # of a panel, inches: room for its caption
LEAST_TRAVEL = 0.025  # of the knot's head end for pictures of it on its way, shares of the length
WORD = (0.26, 0.12)  # inches that "head" or "tail" takes
BARS, BAR = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100), 0.15  # cm, and the most of the length, of the bar that tells the scale
BACKGROUND = 0.98  # of a pixel's colour, where nothing is drawn


@dataclass
class Stage:
    frame: int
    title: str  # empty for a filler, which has none but its phase


@dataclass
class Camera:
    """A view along -Z with +X to the right, turned about X by `pitch` and then about the picture's
    vertical by `yaw` (degrees), as `hagfish picture` takes it."""

    pitch: float
    yaw: float

    def plane(self) -> np.ndarray:
        """World to the picture plane (3 x 2: right, up)."""
        p, y = np.radians([self.pitch, self.yaw])
        up = np.array([0.0, np.cos(p), -np.sin(p)])
        toward = np.array([np.sin(y), np.cos(y) * np.sin(p), np.cos(y) * np.cos(p)])
        return np.stack([np.cross(up, toward), up], axis=1)


def take_stages(log: HagfishLog, hagfish: Path, stages: list[Stage], view: Camera) -> list[Picture]:
    """The animal and the head plate."""
    times = log["/trajectory/time"][[stage.frame for stage in stages]]
    return take_pictures(log.path, times, f"--pitch={view.pitch}", f"--yaw={view.yaw}", hagfish=hagfish)


def plan_crossings(centre: np.ndarray) -> int:
    """How often the centreline (n x 3) crosses itself as seen along Z."""
    start, step = centre[:-1, :2], np.diff(centre[:, :2], axis=0)
    between = start[None, :] - start[:, None]
    area = step[:, None, 0] * step[None, :, 1] - step[:, None, 1] * step[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (between[..., 0] * step[None, :, 1] - between[..., 1] * step[None, :, 0]) / area
        second = (between[..., 0] * step[:, None, 1] - between[..., 1] * step[:, None, 0]) / area
    crossed = (first >= 0) & (first < 1) & (second >= 0) & (second < 1)
    return int(np.triu(crossed, k=2).sum())


def forming_stages(log: HagfishLog) -> list[Stage]:
    """Body crossover, tail wrap and tail insertion (paper, 3.2), told by the shape: the tail has
    crossed the body; it comes round; the centreline has become a knot."""
    form = log.in_phase("form")
    knotted = np.flatnonzero(log["/knot/determinant"][form] == 1)
    inserted = knotted[-1] + 1 if knotted.size else len(form)
    centres = log["/trajectory/position"]
    uncrossed = [k for k in range(inserted) if plan_crossings(centres[form[k]]) == 0]
    if inserted >= len(form) or not uncrossed or uncrossed[-1] + 1 >= inserted:
        return []
    crossed = uncrossed[-1] + 1
    share = lambda a, b, x: form[min(int(round(a + x * (b - a))), len(form) - 1)]
    return [Stage(share(crossed, inserted, 0.22), "body crossover"),
            Stage(share(crossed, inserted, 0.62), "tail wrap"),
            Stage(share(inserted, len(form) - 1, 0.55), "tail insertion")]


def sliding_stages(log: HagfishLog) -> list[Stage]:
    """The tightened knot and the knot a third and two thirds of its way to the head."""
    slide, head_end = log.in_phase("slide"), log["/knot/head_end"]
    slide = slide[np.isfinite(head_end[slide])]
    if not slide.size:
        return []
    start, end = head_end[slide[0]], head_end[slide[-1]]
    stages = [Stage(slide[0], "knot tightened")]
    if abs(end - start) < LEAST_TRAVEL * log["/model/length"].sum():
        return stages
    for share in (1 / 3, 2 / 3):
        passed = np.flatnonzero((head_end[slide] - (start + share * (end - start))) * np.sign(end - start) >= 0)
        stages.append(Stage(slide[passed[0]], f"knot slid {share * abs(end - start):.1f} cm"))
    return stages


def choose_stages(log: HagfishLog) -> list[Stage]:
    """The stages of a whole run; where a run lacks some, the widest gaps in time are filled."""
    release = log.in_phase("release")
    stages = [Stage(0, "start"), *forming_stages(log), *sliding_stages(log)]
    if release.size:
        stages.append(Stage(release[0], "head released"))
    phase, time = log.labels("/trajectory/phase"), log["/trajectory/time"]
    stages.append(Stage(log.frames - 1, "freed" if phase[-1] == "free" else "end of the log"))
    stages = list({stage.frame: stage for stage in stages}.values())
    while len(stages) < min(LEAST_PANELS, log.frames):
        stages.sort(key=lambda stage: stage.frame)
        spans = [b.frame - a.frame for a, b in zip(stages, stages[1:])]
        before = stages[int(np.argmax(spans))]
        frame = before.frame + max(spans) // 2
        stages.append(Stage(frame, ""))
    return sorted(stages, key=lambda stage: time[stage.frame])


def choose_camera(log: HagfishLog, stages: list[Stage]) -> Camera:
    """The view in which the knotted stages hide least of themselves: largest covered area."""
    knotted = [s.frame for s in stages if log["/knot/determinant"][s.frame] != 1] or [stages[-1].frame]
    radius, cell = log["/model/radius"], log["/model/length"].sum() / 170
    best, best_area = Camera(20.0, 18.0), -1.0
    for pitch in range(-180, 180, 10):
        for yaw in (14.0, 22.0):  # enough to show the plate's front, too little to shorten the animal
            view, area = Camera(float(pitch), yaw), 0.0
            for frame in knotted:
                flat = log["/trajectory/position"][frame] @ view.plane()
                low, high = flat.min(axis=0) - radius.max(), flat.max(axis=0) + radius.max()
                columns, rows = (np.arange(low[i], high[i], cell) for i in range(2))
                covered = np.zeros((len(rows), len(columns)), dtype=bool)
                for (x, y), r in zip(flat, radius):
                    covered |= (rows[:, None] - y) ** 2 + (columns[None, :] - x) ** 2 < r * r
                area += covered.sum()
            if area > best_area:
                best, best_area = view, area
    return best


def rows_of(widths: list[float], count: int) -> list[list[int]]:
    """Panels in reading order cut into `count` rows so that the widest row is as narrow as can be."""
    n = len(widths)
    count = min(count, n)
    cuts = min(combinations(range(1, n), count - 1),
               key=lambda cut: max(sum(widths[a:b]) for a, b in zip((0, *cut), (*cut, n))))
    return [list(range(a, b)) for a, b in zip((0, *cuts), (*cuts, n))]


def label_ends(axes: Any, log: HagfishLog, frame: int, view: Camera, picture: Picture, per_cm: float) -> None:
    """Writes "head" and "tail" on axes in cm of the picture plane, `per_cm` inches each: where nothing is drawn and as near as
    can be to that end of the animal, with a line to it."""
    centres = log["/trajectory/position"][frame] @ view.plane()
    drawn = np.any(picture.pixels < BACKGROUND, axis=-1)
    per_pixel = (picture.right - picture.left) / drawn.shape[1]
    half = np.array(WORD) / per_cm / 2
    least, most = np.transpose([axes.get_xlim(), axes.get_ylim()])
    around = [away * np.array([np.cos(angle), np.sin(angle)]) for away in np.arange(0.08, 0.6, 0.02) / per_cm
              for angle in np.linspace(0, 2 * np.pi, 24, endpoint=False)]
    labels: list[np.ndarray] = []

    def free(place: np.ndarray) -> bool:
        low, high = place - half, place + half
        columns = slice(*(max(0, int((x - picture.left) / per_pixel)) for x in (low[0], high[0])))
        rows = slice(*(max(0, int((picture.top - y) / per_pixel)) for y in (high[1], low[1])))
        return bool(np.all(low >= least) and np.all(high <= most) and not drawn[rows, columns].any()
                    and all(np.any(np.abs(place - other) > 2 * half) for other in labels))

    for word, end in (("head", centres[0]), ("tail", centres[-1])):
        place = next((end + offset for offset in around if free(end + offset)), end)
        labels.append(place)
        axes.annotate(word, end, place, fontsize=7, ha="center", va="center",
                      arrowprops={"arrowstyle": "-", "color": plots.INK, "lw": 0.5, "shrinkA": 1, "shrinkB": 0})


def caption(log: HagfishLog, letter: str, stage: Stage) -> str:
    """Letter, stage, phase, time and where the knot is."""
    phase = str(log.labels("/trajectory/phase")[stage.frame])
    word = log.named("phase_description", by="phase")[phase]
    titled = f"{stage.title}\n{word}, " if stage.title else f"{word}\n"
    text = f"({letter}) {titled}$t$ = {log['/trajectory/time'][stage.frame]:.2f} s"
    ends = [log[f"/knot/{end}_end"][stage.frame] for end in ("head", "tail")]
    knotted = log["/knot/determinant"][stage.frame] != 1 and np.all(np.isfinite(ends))
    return text + (f"\nknot spans {ends[0]:.1f} to {ends[1]:.1f} cm" if knotted else "\nno knot")


def fitted(left: np.ndarray, right: np.ndarray) -> tuple[float, list[list[int]]]:
    """The largest scale, inches a cm, at which three rows of panels fit the page, and the rows."""
    for per_cm in np.geomspace(2, 1e-3, 1000):
        widths = list(np.maximum((right - left) * per_cm + 2 * GAP, LEAST_WIDTH))
        rows = rows_of(widths, count=3)
        if max(sum(widths[i] for i in row) for row in rows) <= plots.WIDTH:
            break
    return float(per_cm), rows


def main(path: Path, hagfish: Path, out: Path) -> None:
    log = HagfishLog(path)
    stages = choose_stages(log)
    view = choose_camera(log, stages)
    pictures = take_stages(log, hagfish, stages, view)
    per_cm, rows = fitted(*(np.array([getattr(p, side) for p in pictures]) for side in ("left", "right")))
    cm, gap, across = 1 / per_cm, GAP / per_cm, plots.WIDTH / per_cm  # an inch, the gap, the page in cm of the picture plane
    left = np.array([p.left for p in pictures]) - gap
    right = np.maximum([p.right + gap for p in pictures], left + LEAST_WIDTH * cm)
    text = 0.50  # below each row, inches
    low = [min(pictures[i].bottom for i in row) - gap / 2 for row in rows]
    high = [max(pictures[i].top for i in row) + gap / 2 for row in rows]
    tall = sum((h - l) * per_cm + text for l, h in zip(low, high)) + 0.34
    figure = plt.figure(figsize=(plots.WIDTH, tall))
    top = tall
    for row, bottom, upper in zip(rows, low, high):
        spare = (across - sum(right[i] - left[i] for i in row)) / len(row)
        x, height = 0.0, (upper - bottom) * per_cm
        for i in row:
            width = right[i] - left[i] + spare
            axes = figure.add_axes([x / across, (top - height) / tall, width / across, height / tall])
            p = pictures[i]
            axes.imshow(p.pixels, extent=(p.left, p.right, p.bottom, p.top))
            axes.set(xlim=(left[i], left[i] + width), ylim=(bottom, upper), aspect="auto")
            axes.axis("off")
            label_ends(axes, log, stages[i].frame, view, p, per_cm)
            axes.text(left[i] + 0.03 * cm, bottom - 0.02 * cm, caption(log, ascii_lowercase[i], stages[i]), fontsize=7, va="top",
                      linespacing=1.25, clip_on=False)
            if i == 0:
                bar = max((each for each in BARS if each <= BAR * log["/model/length"].sum()), default=BARS[0])
                end = left[i] + width - 0.15 * cm
                axes.plot([end - bar, end], [bottom + 0.07 * cm] * 2, color="black", lw=1.5, solid_capstyle="butt")
                axes.text(end - bar / 2, bottom + 0.09 * cm, f"{bar:g} cm", fontsize=7, ha="center", va="bottom")
            x += width
        top -= height + text
    rings = ", ".join(f"{100 * station:g}" for station in log.scene()["specimen"]["station"])
    figure.text(0.01, 0.012, f"Rings: {rings} % of the length, where the specimen was measured. Spans: arc length from the head.\n"
                "Grey: head plate, pale once the head is free.", fontsize=7)
    plots.save(figure, out, DPI)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "HAGFISH", "OUT.png"], main)
