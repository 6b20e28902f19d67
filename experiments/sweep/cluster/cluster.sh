#!/usr/bin/env bash
# From one machine to a cluster: 1,000 short runs by `hagfish sweep` alone, and again in ten parts by Snakemake and a Slurm that this
# script starts and stops. Meanwhile one worker is killed, and one job cancelled, as if its node had failed. The two tables must be the
# same, byte for byte. Then searches for a 3_1 by three seeds, of which one is made without Slurm, too, to be the same. Leaves alone/ and
# slurm/, each with table.csv, the latter with table.h5 and page.html, and searches/ and search/.
# Stopped, it goes on where it was.
set -euo pipefail
export HAGFISH_CLUSTER=1 # has setup.sh install Snakemake and Slurm
source "$(dirname "${BASH_SOURCE[0]}")/../../results/common.sh"
grid=$page/grid.toml

# A Slurm of one node on this machine's loopback address: `start_slurm FOLDER` starts munged, slurmctld and slurmd, with keys, state and
# ports of their own, as whoever calls it; `stop_slurm` ends just these.
slurm_pids=()

start_slurm() {
  local folder=$1 host user memory
  host=$(hostname -s)
  user=$(id -un)
  memory=$(awk '/MemTotal/ { print int($2 / 1024) }' /proc/meminfo) # MB
  mkdir -p "$folder"/{state,spool}
  chmod 700 "$folder"
  dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
  chmod 400 "$folder/munge.key"
  munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munge.seed" --num-threads=2 &>"$folder/munged.out" &
  slurm_pids+=($!)
  cat >"$folder/slurm.conf" <<CONF
ClusterName=one-node
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ReturnToService=2
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$folder/slurm.conf
  slurmctld -D &>"$folder/slurmctld.out" &
  slurm_pids+=($!)
  slurmd -D &>"$folder/slurmd.out" &
  slurm_pids+=($!)
  for _ in {1..60}; do
    [[ $(sinfo --noheader --format=%T 2>/dev/null) == idle ]] && return
    sleep 1
  done
  echo "Slurm does not come up; see $folder/*.log" >&2
  return 1
}

# The last one that was started first.
stop_slurm() {
  local i
  for ((i = ${#slurm_pids[@]} - 1; i >= 0; --i)); do
    kill "${slurm_pids[i]}" 2>/dev/null && wait "${slurm_pids[i]}" 2>/dev/null
  done
  slurm_pids=()
}

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
