# A command starts without what it does not use: each shared library is work for the loader at every start, and OpenImageIO brings 250.
. "$(dirname "$0")/check.sh"
libraries=$(LD_TRACE_LOADED_OBJECTS=1 "$ABBE_BUILD/cli/abbe")
contains "libraries at the start" "$libraries" libembree3
[[ $libraries != *libOpenImageIO* ]] || fail "OpenImageIO is loaded at the start"
count=$(wc -l <<<"$libraries")
[ "$count" -le 50 ] || fail "$count shared libraries at the start (allowed 50)"
