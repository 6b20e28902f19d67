"""What each back end takes for the QPs of a run, and how exact it is.

Usage: qp_table.py QPS.csv OUT_FOLDER, where QPS.csv is of `hagfish qp --csv`.
"""

from pathlib import Path

from script import run_script
from tables import read_csv, write_table

COLUMNS = ("back_end", "start", "qps", "median_s", "p99_s", "failures", "error_norm_relative", "kkt")


def main(table: Path, out: Path) -> None:
    rows = [[f"{row['back_end']}, {row['start']}", f"{1e6 * float(row['median_s']):.3g}", f"{1e6 * float(row['p99_s']):.3g}",
             f"{float(row['kkt']):.1e}", f"{float(row['error_norm_relative']):.1e}", f"{row['failures']} of {row['qps']}"]
            for row in read_csv(table, COLUMNS)]
    write_table(out, "qps", ["back end, start", "median, µs", "99 %, µs", "worst KKT residual",
                             "worst error of the velocity, H norm", "failures"], rows)


if __name__ == "__main__":
    run_script(__doc__, ["QPS.csv", "OUT_FOLDER"], main)
