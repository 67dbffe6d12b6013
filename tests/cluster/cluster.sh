# To be sourced: a Slurm cluster of three nodes, n1 to n3 with a processor each, on the loopback interface. Jobs of the partition `urgent` send
# those of `all` back into the queue. All its files are in `$folder`, and what it starts ends with the shell.

port=$((20000 + RANDOM % 20000))
host=$(hostname -s)
daemons=()
declare -A node_daemon

# Of slurmstepd, those that the daemons of this cluster have left: by the configuration in their environment.
steps_left() {
  local process
  for process in $(pgrep -x slurmstepd); do
    grep -qsF "$folder/slurm.conf" "/proc/$process/environ" && echo "$process"
  done
}

start_node() {
  start "slurmd-$1" slurmd -D -N "$1"
  node_daemon[$1]=${daemons[-1]}
}

# As when its machine loses power: the daemon and all that runs for jobs there, by the node's name in their environment, at once.
lose_node() {
  local process lost=("${node_daemon[$1]}")
  for process in $(pgrep -u "$(id -u)"); do
    grep -qszFx "SLURMD_NODENAME=$1" "/proc/$process/environ" && grep -qszFx "SLURM_CONF=$folder/slurm.conf" "/proc/$process/environ" &&
      lost+=("$process" "$(ps -o ppid= -p "$process")")
  done
  for process in "${lost[@]}"; do
    case $(ps -o comm= -p $process) in slurmctld | munged | bash | "") ;; *) kill -KILL $process 2>/dev/null || true ;; esac
  done
}

# Jobs first, since the daemons wait for each other to tell how they ended.
stop_cluster() {
  local process
  scancel --user="$(id -un)" 2>/dev/null || true
  until_true 20 eval '[ -z "$(squeue --noheader 2>/dev/null)" ]' || true
  for process in "${daemons[@]}"; do kill -TERM "$process" 2>/dev/null || true; done
  until_true 10 eval '! kill -0 "${daemons[@]}"' || true
  for process in "${daemons[@]}" $(steps_left); do kill -KILL "$process" 2>/dev/null || true; done
  wait
  rm -rf "$folder"
}

start() {  # start NAME COMMAND...: in the background, its output to NAME.log
  "${@:2}" >"$folder/$1.log" 2>&1 &
  daemons+=($!)
}

until_true() {  # until_true SECONDS COMMAND...
  local left=$(($1 * 5))
  until "${@:2}" >/dev/null 2>&1; do
    left=$((left - 1))
    [ $left -gt 0 ] || { echo "gave up waiting for: ${*:2}" >&2; return 1; }
    sleep 0.2
  done
}

write_configuration() {
  cat >"$folder/slurm.conf" <<EOF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MinJobAge=3600
ReturnToService=2
KillWait=5
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
NodeName=n3 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 3)) CPUs=1
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
PartitionName=all Nodes=n1,n2,n3 Default=YES MaxTime=INFINITE State=UP PriorityTier=1 GraceTime=20
PartitionName=urgent Nodes=n1,n2,n3 MaxTime=INFINITE State=UP PriorityTier=2 PreemptMode=OFF
EOF
  : >"$folder/cgroup.conf"
  export SLURM_CONF=$folder/slurm.conf
}

start_cluster() {
  local node
  mkdir -p "$folder/state" "$folder/spool-n1" "$folder/spool-n2" "$folder/spool-n3"
  chmod 711 "$folder"  # for whom munged answers
  write_configuration
  dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
  chmod 400 "$folder/munge.key"
  start munged munged --foreground --key-file "$folder/munge.key" --socket "$folder/munge.socket" \
    --pid-file "$folder/munge.pid" --log-file "$folder/munge.log" --seed-file "$folder/munge.seed"
  until_true 10 munge --socket "$folder/munge.socket" --no-input
  start slurmctld slurmctld -D
  for node in n1 n2 n3; do start_node $node; done
  until_true 25 eval '[ "$(sinfo --noheader --Node --partition=all --states=idle --format=%N | wc -l)" -eq 3 ]'
}
