# Searches for a knot by many seeds (`hagfish design`), wherever Snakemake's profile says, and what they found in one table.
#
#   snakemake --snakefile experiments/sweep/cluster/design.smk --profile experiments/sweep/cluster/profiles/local \
#     --config knot="'KNOT'" out=FOLDER seeds=N [budget=15m] [specimen=FILE] [threads=T] [hagfish=PROGRAM]
#
# Leaves FOLDER/SEED/, what `hagfish design` leaves, for seeds 1 to N, and FOLDER/found.csv, a row for each seed that tied the knot, the soft
# body at least: see its column `found`. A search that is killed goes on where it was when it is tried again.
from pathlib import Path

for key in ("knot", "out"):
    if key not in config:
        raise WorkflowError(f"--config {key}=... is missing")

ROOT = Path(workflow.basedir).parents[2]
PROGRAM = config.get("hagfish", ROOT / "build/release/experiments/hagfish")
if not isinstance(config["knot"], str):
    raise WorkflowError("--config knot: a name such as 3_1 is read as a number; write knot=\"'3_1'\"")
KNOT, OUT, SEEDS, BUDGET = config["knot"], config["out"], int(config.get("seeds", 8)), config.get("budget", "15m")
SPECIMEN = ["--specimen", config["specimen"]] if "specimen" in config else []


rule all:
    input: f"{OUT}/found.csv"


localrules: all, gather


rule search:
    output: touch(f"{OUT}/{{part}}.done")
    log: f"{OUT}/{{part}}.log"
    threads: int(config.get("threads", 1))
    resources:
        mem_mb=lambda wildcards, threads: 500 + 100 * threads,
    retries: 3
    shell:
        "resume=; [ ! -e {OUT:q}/{wildcards.part}/search.toml ] || resume=--resume; "
        "{PROGRAM:q} design {KNOT:q} --seed {wildcards.part} --out {OUT:q}/{wildcards.part} --budget {BUDGET:q} --threads {threads} {SPECIMEN:q} $resume "
        ">>{log:q} 2>&1 || [ $? -eq 3 ]"


rule gather:
    input: expand(f"{OUT}/{{part}}.done", part=range(1, SEEDS + 1))
    output: f"{OUT}/found.csv"
    run:
        rows = [file.read_text().splitlines() for seed in range(1, SEEDS + 1) if (file := Path(OUT, str(seed), "result.csv")).exists()]
        Path(output[0]).write_text("".join(f"{line}\n" for line in [*(rows[0][:1] if rows else []), *(row[1] for row in rows)]))
