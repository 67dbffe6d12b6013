# The Dockerfile and the Kubernetes jobs as far as no container engine is needed: what they name exists, their shell is sound, the tasks are
# those of docs/guide/machines.md, and the jobs' scripts render and merge the film of a single run.
. "$(dirname "$0")/check.sh"
cd "$ABBE_SOURCE"
dockerfile=$(sed -e '/^#/d' -e ':join' -e '/\\$/{N;s/\\\n//;b join' -e '}' containers/Dockerfile)
last() { sed -n "s/^$1 //p" <<<"$dockerfile" | tail -1; }

equal "base" "$(last ARG)" "BASE=docker.io/library/debian:12-slim"
equal "bases of the stages" "$(grep '^FROM' <<<"$dockerfile" | paste -sd ' ')" 'FROM ${BASE} AS build FROM ${BASE}'
equal "entry point" "$(last ENTRYPOINT)" '["abbe"]'
user=$(last USER)
equal "user and group" "$user" "${user%:*}:${user%:*}"
[ "${user%:*}" -gt 0 ] || fail "user $user is root or has no number"
while read -r sources; do
  for file in ${sources% *}; do [ -e "$file" ] || fail "the Dockerfile copies $file, which is not there"; done
done < <(sed -n 's/^COPY //p' <<<"$dockerfile")
contains "what the image leaves behind" "$(last RUN)" "apt-get clean && rm -rf /var/lib/apt/lists/*"
packages=$(grep -v '^#' .ci/packages)
absent=$(comm -23 <(sort <<<"$packages") <(dpkg-query -W -f='${Package}\n' | sort -u))  # those here are Debian's: to ask for all takes seconds
known=$([ -z "$absent" ] || apt-cache show --no-all-versions $absent 2>/dev/null | sed -n 's/^Package: //p')
equal "packages that Debian has not" "$(comm -23 <(printf '%s' "$absent") <(sort <<<"$known") | paste -sd ' ')" ""

/usr/bin/python3 -B tests/install/manifest.py containers/job.yaml "${user%:*}" "$(last WORKDIR)" "$scratch"
sed -n 's/^RUN \(--mount=[^ ]* \)*//p' <<<"$dockerfile" >"$scratch/run"
for script in render merge run; do
  sh -n "$scratch/$script"
  shellcheck --shell=sh "$scratch/$script" || fail "shellcheck of $script"
done

# Both ways to run a task give the program the same words.
mkdir "$scratch/said"
printf '#!/bin/sh\necho abbe "$@"\n' >"$scratch/said/abbe"
printf '#!/bin/sh\nwhile [ "${1#-}" != "$1" ]; do shift; done\nexec "$@"\n' >"$scratch/said/srun"
chmod +x "$scratch/said/"*
cp docs/guide/slurm/render.sbatch "$scratch/array"
array=$(sed -n 's/^#SBATCH.*--array=0-\([0-9]*\).*/\1/p' "$scratch/array")
cpus=$(sed -n 's/^#SBATCH.*--cpus-per-task=\([0-9]*\).*/\1/p' "$scratch/array")
. "$scratch/environment"
equal "tasks" "$TASKS" "$((array + 1))"
for count in "$TASKS" 7; do  # by which the samples divide, and do not
  next=0
  for task in $(seq 0 $((count - 1))); do
    words=$(TASKS=$count JOB_COMPLETION_INDEX=$task PATH=$scratch/said:$PATH sh -eu "$scratch/render")
    documented=$(SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=$count SLURM_CPUS_PER_TASK=$cpus PATH=$scratch/said:$PATH sh "$scratch/array")
    equal "task $task" "$words" "$documented"
    contains "first sample of task $task" "$documented" "--sample-range $next:"
    next=${documented#*--sample-range "$next":}
    next=${next%% *}
  done
  equal "end of the samples of $count tasks" "$next" "$SPP"
done

# Merging begins before the parts are there; one task runs twice, and the samples do not divide by the tasks.
mkdir "$scratch/volume" "$scratch/quick"
printf '#!/bin/sh\nexec /bin/sleep 0.05\n' >"$scratch/quick/sleep"
chmod +x "$scratch/quick/sleep"
cp data/scenes/furnace.json "$scratch/volume/scene.json"
cd "$scratch/volume"
export SPP=10 TASKS=4 CPUS=1 PATH=$scratch/quick:$ABBE_BUILD/cli:$PATH
timeout 60 sh -eu "$scratch/merge" >merge.log 2>&1 &
merge=$!
for task in 3 1 1 2 0; do JOB_COMPLETION_INDEX=$task sh -eu "$scratch/render" 2>/dev/null || fail "task $task"; done
wait "$merge" || fail "merge: $(<merge.log)"
contains "what merge waited for" "$(<merge.log)" "waiting for part-0.abbepart"
abbe render scene.json --spp 10 --quiet -o single.exr
contains "same film" "$(abbe compare scene.exr single.exr --json)" '"relMSE":0.0,"rmse":0.0,"mean_ratio":1.0,'
