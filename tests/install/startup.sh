# A command starts without what it does not use: each shared library is work for the loader at every start, and OpenImageIO brings 250.
. "$(dirname "$0")/check.sh"
libraries=$(LD_TRACE_LOADED_OBJECTS=1 "$ABBE_BUILD/cli/abbe")
contains "libraries at the start" "$libraries" libembree3
[[ $libraries != *libOpenImageIO* ]] || fail "OpenImageIO is loaded at the start"
count=$(wc -l <<<"$libraries")
[ "$count" -le 50 ] || fail "$count shared libraries at the start (allowed 50)"
# Nor does a render with a PNG to look at.
opened=$(LD_DEBUG=files "$ABBE_BUILD/cli/abbe" render "$ABBE_SOURCE/data/scenes/furnace.json" --spp 1 --set /sensor/resolution=[8,8] --quiet \
  -o "$scratch/film.exr" --display "$scratch/picture.png" 2>&1)
contains "libraries of a render" "$opened" libembree3
[[ $opened != *libOpenImageIO* ]] || fail "OpenImageIO is loaded to write a PNG"
