# The image's second stage, built on a Debian that debootstrap makes and from the package of this build, renders as its own user what the same
# program renders outside, and the Kubernetes jobs' scripts run in it.
. "$(dirname "$0")/check.sh"
[ "$(id -u)" -eq 0 ] && command -v buildah >/dev/null && command -v debootstrap >/dev/null || { echo "skipped: needs root, buildah and debootstrap"; exit 77; }
engine() { buildah --storage-driver vfs --root "$scratch/storage" --runroot "$scratch/run" "$@"; }
quietly() { "$@" >"$scratch/log" 2>&1 || fail "$*: $(tail -5 "$scratch/log")"; }

debootstrap --variant=minbase bookworm "$scratch/base" >"$scratch/log" 2>&1 || { echo "skipped: no Debian to be had: $(tail -1 "$scratch/log")"; exit 77; }
container=$(engine from scratch)
quietly engine add "$container" "$scratch/base" /
quietly engine commit "$container" localhost/base

mkdir -p "$scratch/build/package" "$scratch/volume"
(cd "$ABBE_BUILD" && quietly cpack -G DEB -B "$scratch/build/package")
quietly engine bud --isolation chroot --build-arg BASE=localhost/base --build-context build="$scratch/build" \
  -f "$ABBE_SOURCE/containers/Dockerfile" -t localhost/abbe "$ABBE_SOURCE/containers"
setting() { engine inspect --type image --format "{{.OCIv1.Config.$1}}" localhost/abbe; }
equal "entry point" "$(setting Entrypoint)" "[abbe]"
user=$(setting User)

container=$(engine from localhost/abbe)
inside() { engine run --isolation chroot -v "$scratch/volume:$(setting WorkingDir)" "$container" -- "$@"; }
equal "user" "$(inside id -u)" "${user%:*}"
left=$(engine run --isolation chroot --user root "$container" -- find /var/lib/apt/lists /var/cache/apt -type f ! -name lock)
equal "caches of packages" "$left" ""
contains "tables" "$(inside abbe --version)" $'\ndata /usr/share/abbe/data\n'

# One thread or two, inside or outside, in one run or in parts.
cp "$ABBE_SOURCE/data/scenes/furnace.json" "$scratch/volume/scene.json"
chmod 755 "$scratch"
chown -R "$user" "$scratch/volume"
inside abbe render scene.json --spp 10 --threads 2 --quiet -o inside.exr
dpkg-deb -x "$scratch"/build/package/abbe_*.deb "$scratch/outside"
abbe=$scratch/outside/usr/bin/abbe
"$abbe" render "$scratch/volume/scene.json" --spp 10 --threads 1 --quiet -o "$scratch/outside.exr"
/usr/bin/python3 -B "$ABBE_SOURCE/tests/install/manifest.py" "$ABBE_SOURCE/containers/job.yaml" "${user%:*}" "$(setting WorkingDir)" "$scratch"
for task in 0 1 2 3; do
  inside env SPP=10 TASKS=4 CPUS=1 JOB_COMPLETION_INDEX=$task sh -euc "$(<"$scratch/render")"
done
inside env SPP=10 TASKS=4 sh -euc "$(<"$scratch/merge")"
for film in inside scene; do
  contains "bits of $film.exr" "$("$abbe" compare "$scratch/volume/$film.exr" "$scratch/outside.exr" --json)" '"relMSE":0.0,"rmse":0.0,"mean_ratio":1.0,'
done
