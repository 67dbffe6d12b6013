# Sourced by the tests of this folder. They get ABBE_SOURCE and ABBE_BUILD, work in a scratch folder of their own and must not see ABBE_DATA.
set -euo pipefail
unset ABBE_DATA
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
  printf 'failed: %s\n' "$*" >&2
  exit 1
}
equal() {  # WHAT GOT WANTED
  [ "$2" = "$3" ] || fail "$1 (got \"$2\", wanted \"$3\")"
}
contains() {  # WHAT TEXT PART
  [[ $2 == *"$3"* ]] || fail "$1 (got \"$2\", wanted \"$3\" in it)"
}

nightly() { [ -n "${ABBE_NIGHTLY:-}" ]; }  # whether there is time for all

install_to() {
  cmake --install "$ABBE_BUILD" --prefix "$1" >"$scratch/install.log" || fail "cmake --install: $(tail -5 "$scratch/install.log")"
}

# The installed program at PROGRAM answers from the tables of DATA: it names that folder and its hash, finds a glass, renders.
check_program() {  # PROGRAM DATA
  local version scene=$2/scenes/furnace.json
  version=$("$1" --version)
  equal "first line of --version" "${version%%$'\n'*}" "abbe $(sed -n 's/^version: //p' "$ABBE_SOURCE/CITATION.cff")"
  contains "data folder" "$version" $'\ndata '"$2"$'\n'
  contains "data hash" "$version" $'\ndata_sha256 '"$(sha256_of "$ABBE_SOURCE/data")"$'\n'
  contains "index of N-BK7" "$("$1" query ior N-BK7 --at 587.5618 --json)" '"n":1.51680003'
  "$1" render "$scene" --spp 2 --quiet --threads 1 -o "$scratch/film.exr" --stats "$scratch/stats.json"
  contains "data hash of a render" "$(<"$scratch/stats.json")" "$(sha256_of "$2")"
}

# What io/data_directory.h says the hash of the tables is.
sha256_of() {
  (cd "$1" && find . -name '*.csv' -not -path './scenes/*' -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' sha256sum | sha256sum | cut -d ' ' -f 1)
}
