"""What one run says of the paper's claims, as a CSV row, whatever the run came to. Usage: claim_row.py LOG.h5 OUT.csv"""

import numpy as np

import claims
from hagfish_log import HagfishLog
from script import run_script
from slides import tied
from tables import write_csv

MEASURES = ["slide_cm", "beyond_dyn_cm", "near_over_far", "roughness_space", "roughness_time", "dct_modes_95"]
HEADING = ["outcome", *MEASURES, *claims.NAMES]


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


def row_of(log: HagfishLog) -> list[object]:
    """Of HEADING; a run that did not slide, or hardly, has its outcome alone."""
    outcome = outcome_of(log)
    if outcome == "slid":
        try:
            s = claims.read_sliding(log)
            a, b, c = claims.zero_behind(s), claims.larger_near_head(s), claims.smooth_in_space(s)
            worst = lambda key: max(own[key] for own in c["axes"].values())
            verdict = claims.verdicts(a, b, c)
            return [outcome, float(s.head_end[0] - s.head_end[-1]), float(a["largest_beyond_reach_of_rows_dyn_cm"]),
                    float(b["measures"][claims.EFFORT]["near_over_far"]), worst("roughness_in_space"), worst("roughness_in_time"),
                    worst("dct_modes_95"), *(verdict[name] for name in claims.NAMES)]
        except claims.ShortSlide:
            outcome = "hardly slid"
    return [outcome, *[np.nan] * len(MEASURES), *[""] * len(claims.NAMES)]


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.csv"], lambda log, out: write_csv(out, HEADING, [row_of(HagfishLog(log))]))
