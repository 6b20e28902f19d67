# shellcheck shell=bash
# Sourced, not run: a Slurm of one node on this machine's loopback address, for trials. `start_slurm FOLDER` starts munged,
# slurmctld and slurmd, with keys, state and ports of their own, as whoever calls it; `stop_slurm` ends just these. Leaves
# SLURM_CONF. Debian's packages: munge, slurmctld, slurmd, slurm-client.
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
