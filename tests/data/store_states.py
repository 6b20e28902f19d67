"""Picks states of every phase from a Table 1 log, for tests/validation/equation4_test.cpp and others.

Usage: store_states.py LOG.h5 OUT.toml
"""

import sys

import h5py
import numpy as np

SHARE = {"form early": ("form", 0.3), "form": ("form", 0.95), "tighten": ("tighten", 0.5),
         "slide": ("slide", 0.2), "slide late": ("slide", 0.85), "release": ("release", 0.4), "free": ("free", 0.3)}


def row(values: np.ndarray) -> str:
    return "[" + ", ".join(repr(float(v)) for v in values) + "]"


def main(log_name: str, out_name: str) -> None:
    with h5py.File(log_name) as log, open(out_name, "w", encoding="utf-8") as out:
        phase = log["trajectory/phase"][()]
        words = {word: value for word, value in h5py.check_enum_dtype(log["trajectory/phase"].dtype).items()}
        out.write("# States of a Table 1 run (h = 2 ms), one or two a phase.\n"
                  "# Written by store_states.py. q, qdot: as in the log; cm, s, rad.\n")
        for name, (word, share) in SHARE.items():
            frames = np.flatnonzero(phase == words[word])
            frame = frames[int(share * len(frames))]
            out.write(f'\n[[state]]\nname = "{name}"\nphase = {words[word]}\n'
                      f"step = {int(log['trajectory/step'][frame])}\n"
                      f"q = {row(log['trajectory/q'][frame])}\nqdot = {row(log['trajectory/qdot'][frame])}\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
