#!/usr/bin/env bash
# slurm.sh ABBE DOCS: the documented job array on a real Slurm cluster, of which a task is killed, one makes way for an urgent job, one is put
# back into the queue by hand, some reach their time limit, a node is lost and another drained: the film has the bits of a single run, and
# parts of other builds and scenes are refused. Exits with 77 where there is no Slurm.
set -euo pipefail
abbe=$1 docs=$2
for command in munged slurmctld slurmd sbatch objcopy; do
  command -v $command >/dev/null || { echo "skipped: no $command (Debian: slurm-wlm munge binutils)"; exit 77; }
done
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
folder=$(mktemp -d)
. "$here/cluster.sh"
trap stop_cluster EXIT

fail() {
  echo "slurm.sh: $*" >&2
  tail -n 20 "$folder"/*.log "$folder"/job/slurm-*.out >&2 || true
  exit 1
}

field() {  # field JOB NAME: what `scontrol show job` has under it
  scontrol show job "$1" 2>/dev/null | tr ' ' '\n' | sed -n "s/^$2=//p" | head -n 1
}
is() { [ "$(field "$1" "$2")" = "$3" ]; }
restarts() { field "${array}_$1" Restarts; }
on() {  # on NODE: sets `task` to the one that renders there, and `before` to how often it was put back into the queue
  task=$(squeue --noheader --nodelist="$1" --states=RUNNING --partition=all --format=%K)
  [ -n "$task" ] && before=$(restarts "$task")
}
back() {  # back TASK WHY: it is put back into the queue once more
  until_true 120 eval '[ "$(restarts '"$1"')" -gt '"$before"' ]' || fail "task $1 was not requeued after $2"
}

start_cluster || fail "no cluster"
mkdir "$folder/job"
cd "$folder/job"
cp "$docs"/guide/slurm/* .
ln -s "$abbe" "$folder/abbe"
export PATH=$folder:$PATH
cat >scene.json <<'EOF'
{"abbe": 1, "units": "mm",
 "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -300, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
 "sensor": {"resolution": [320, 200], "observer": "1931"},
 "materials": {"white": {"diffuse": {"reflectance": 0.8}}},
 "lights": [{"environment": {}, "emission": {"illuminant": "D65", "radiance": 1}}],
 "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 50}, "material": "white"}],
 "output": {"display": "picture.png"}}
EOF

# Warned of their limit after 10 to 40 s, since Slurm looks every 30 s.
merge=$(sh submit.sh --array=0-4 --cpus-per-task=1 --time=1 --signal=TERM@50 | sed 's/.* //')
array=$((merge - 1))
until_true 60 grep -q "starting from the first sample" "slurm-${array}_0.out" || fail "the first task does not start"
before=0
scancel --signal=KILL "$(field "${array}_0" JobId).0"
back 0 "a kill"

# What makes way has time to save what it has, once it is at work.
has_saved() { [ -s "at-$(($1 * 4096 / 5)).abbepart" ]; }
at_work() { on "$1" && { has_saved "$task" || tail -n 1 "slurm-${array}_$task.out" | grep "starting from the first sample"; }; }
saved() { until_true 20 has_saved "$1" || fail "task $1 saved nothing before $2"; }
until_true 60 at_work n1 || fail "no task on n1"
urgent=$(sbatch --parsable --partition=urgent --nodelist=n1 --wrap="sleep 1")
until_true 120 is "$urgent" JobState COMPLETED || fail "the urgent job did not run"
back "$task" "an urgent job"
saved "$task" "an urgent job"
until_true 120 at_work n2 || fail "no task on n2"
scontrol requeue "$(field "${array}_$task" JobId)"
back "$task" "a requeue by hand"
saved "$task" "a requeue by hand"

# A machine that is gone holds no locks; it comes back when another leaves.
until_true 120 on n3 || fail "no task on n3"
lose_node n3
scontrol update NodeName=n3 State=DOWN Reason=lost
back "$task" "its node was lost"
start_node n3
scontrol update NodeName=n3 State=RESUME
scontrol update NodeName=n2 State=DRAIN Reason=test
until_true 900 eval 'case $(field '"$merge"' JobState) in COMPLETED|FAILED|TIMEOUT) ;; *) false ;; esac' || fail "the merge did not run"
is "$merge" JobState COMPLETED || fail "the merge failed"

total=0
for task in 0 1 2 3 4; do
  is "${array}_$task" JobState COMPLETED || fail "task $task is $(field "${array}_$task" JobState)"
  total=$((total + $(restarts $task)))
done
[ $total -ge 5 ] || fail "no task was requeued at its time limit"
[ "$(sinfo --noheader --partition=all --nodes=n2 --format=%T)" = drained ] || fail "n2 is not drained"
[ ! -e picture.png ] || fail "a part wrote the picture"
abbe render scene.json --spp 4096 --quiet -o single.exr --display single.png
cmp single.exr scene.exr || fail "the film differs from that of a single run"

# Another build differs by its id, another scene by its hash.
objcopy --dump-section .note.gnu.build-id=note "$abbe" /dev/null
printf '\377' | dd of=note bs=1 seek=20 conv=notrunc status=none
objcopy --update-section .note.gnu.build-id=note "$abbe" "$folder/other"
refused() {  # refused WHY PROGRAM OPTION...: a part that is not merged with the others, for that reason
  "$folder/$2" render scene.json --spp 4096 --sample-range 1638:1639 --quiet -o other.abbepart "${@:3}"
  local code=0
  abbe merge --partial part-0.abbepart other.abbepart -o no.exr 2>message || code=$?
  [ $code -eq 4 ] && grep -q "another $1" message && [ ! -e no.exr ] || fail "not refused for its $1: $(cat message)"
}
refused build other
refused scene_sha256 abbe --set /shapes/0/sphere/radius=51
echo "5 tasks, requeued $total times: the bits of a single run"
