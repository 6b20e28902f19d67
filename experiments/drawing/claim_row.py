"""What one run says of the paper's claims, whatever the run came to."""

from typing import Any

import claims
from hagfish_log import HagfishLog
from slides import tied

MEASURES = ["slide_cm", "beyond_dyn_cm", "near_over_far", "roughness_space", "roughness_time", "dct_modes_95"]


def outcome_of(log: HagfishLog) -> str:
    """What the run came to, in a word or two."""
    if not tied(log):
        return "not tied"
    if str(log.attribute("status")) != "complete":
        return "stopped"
    slide = log.in_phase("slide")
    if not slide.size:
        return "not tight"
    # A slide ends where the knot is let go, however it comes there, or with the run's time.
    time = log["/trajectory/time"]
    settings = log.scene()["time"]
    cut_off = slide[-1] == len(time) - 1 and time[-1] + 1.5 * settings["frame_interval"] >= settings["duration"]
    return "jammed" if cut_off else "slid"


def judged(log: HagfishLog) -> dict[str, Any]:
    """The outcome; of a run that slid far enough also its MEASURES and, by claims.NAMES, the verdicts."""
    outcome = outcome_of(log)
    if outcome != "slid":
        return {"outcome": outcome}
    try:
        s = claims.read_sliding(log)
    except claims.ShortSlide:
        return {"outcome": "hardly slid"}
    a, b, c = claims.zero_behind(s), claims.larger_near_head(s), claims.smooth_in_space(s)
    worst = [max(own[key] for own in c["axes"].values()) for key in ("roughness_in_space", "roughness_in_time", "dct_modes_95")]
    measured = [float(s.head_end[0] - s.head_end[-1]), float(a["largest_beyond_reach_of_rows_dyn_cm"]),
                float(b["measures"][claims.EFFORT]["near_over_far"]), *worst]
    return {"outcome": outcome, **dict(zip(MEASURES, measured, strict=True)), **claims.verdicts(a, b, c)}
