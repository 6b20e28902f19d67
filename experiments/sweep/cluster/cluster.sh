#!/usr/bin/env bash
# From one machine to a cluster: 1,000 short runs by `hagfish sweep` alone, and again in ten parts by Snakemake and a Slurm that this
# script starts and stops. Meanwhile one worker is killed, and one job cancelled, as if its node had failed. The two tables must be the
# same, byte for byte. Then searches for a 3_1 by three seeds, of which one is made without Slurm, too, to be the same. Leaves alone/ and
# slurm/, each with table.csv, the latter with table.h5 and page.html, and searches/ and search/.
# Stopped, it goes on where it was.
set -euo pipefail
export HAGFISH_CLUSTER=1 # has setup.sh install Snakemake and Slurm
source "$(dirname "${BASH_SOURCE[0]}")/../../results/common.sh"
source "$root/experiments/sweep/cluster/one_node_slurm.sh"
grid=$grids/cluster.toml

# Sockets have short names.
slurm=$(mktemp -d)
end() {
  [[ -z ${snakemake-} ]] || kill "$snakemake" 2>/dev/null || true
  stop_slurm
  rm -rf "$slurm"
  elapsed
}
trap end EXIT

echo "1,000 short runs on this machine"
/usr/bin/time -f "%M kB at most, %e s" "$hagfish" sweep "$grid" --out "$out/alone"

echo "The same through Slurm"
start_slurm "$slurm"
# All cores of the node are Slurm's to give away, also those that this shell may not use.
(
  cd "$slurm"
  exec snakemake --snakefile "$root/experiments/sweep/cluster/Snakefile" --profile "$root/experiments/sweep/cluster/profiles/slurm" \
    --latency-wait 10 --config grid="$grid" out="$out/slurm" parts=10 hagfish="$hagfish"
) &>"$out/snakemake.log" &
snakemake=$!

# rows: how many lines there are of parts that are not done.
rows() { cat "$out"/slurm/table.*.part 2>/dev/null | wc -l; }
# worker JOB: the id of its hagfish.
worker() {
  local pid
  for pid in $(scontrol listpids "$1" 2>/dev/null | awk 'NR > 1 { print $1 }'); do
    if [[ $(cat "/proc/$pid/comm" 2>/dev/null) == hagfish ]]; then echo "$pid"; fi
  done
}
running() { squeue --noheader --format=%i --states=RUNNING | sort -n; }
killed=0
while ((killed < 2)) && kill -0 "$snakemake" 2>/dev/null; do
  sleep 2
  job=$(running | head -n 1)
  if [[ -z $job ]] || (($(rows) < 20)); then continue; fi
  if ((killed == 0)); then
    pid=$(worker "$job")
    [[ -n $pid ]] || continue
    echo "Killing the worker of job $job, with $(rows) rows of parts in work"
    kill -9 "$pid"
  else
    echo "Cancelling job $job, with $(rows) rows of parts in work"
    scancel --signal=KILL --full "$job"
  fi
  killed=$((killed + 1))
  sleep 10
done
wait "$snakemake" || { tail -n 30 "$out/snakemake.log" >&2; exit 1; }
snakemake=
if ((killed < 2)); then echo "Snakemake was done before two workers were killed" >&2; exit 1; fi

cmp "$out/alone/table.csv" "$out/slurm/table.csv"
echo "$(($(wc -l <"$out/slurm/table.csv") - 1)) rows, the same byte for byte"
echo "Parts that went on where they had been stopped:"
grep -h ' of them now' "$out"/slurm/parts/*.log | grep -v ' 100 of them' | sed 's/^[^:]*: /  /'

echo "Searches for a 3_1 by three seeds through Slurm"
(
  cd "$slurm"
  exec snakemake --snakefile "$root/experiments/sweep/cluster/design.smk" --profile "$root/experiments/sweep/cluster/profiles/slurm" \
    --latency-wait 10 --config knot="'3_1'" out="$out/searches" seeds=3 hagfish="$hagfish"
) &>"$out/searches.log" || { tail -n 30 "$out/searches.log" >&2; exit 1; }
[[ -e $out/search/result.csv ]] || "$hagfish" design 3_1 --seed 2 --out "$out/search" --quiet
for table in tries candidates; do cmp <(sort "$out/search/$table.csv") <(sort "$out/searches/2/$table.csv"); done
echo "$(awk -F, 'NR > 1 && $3 == "yes"' "$out/searches/found.csv" | wc -l) of 3 found; that of seed 2 is the same without Slurm"
