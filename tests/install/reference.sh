# What is written of the command line is what the program says of it.
. "$(dirname "$0")/check.sh"
program=$ABBE_BUILD/cli/abbe
"$program" help --format markdown | diff -u "$ABBE_SOURCE/docs/reference/commands.md" - ||
  fail "docs/reference/commands.md is out of date; write it anew with: cmake --build --preset release --target reference"

"$program" help --format man >"$scratch/abbe.1"
equal "complaints of groff" "$(groff -man -ww -z -b "$scratch/abbe.1" 2>&1)" ""
page=$(groff -man -Tascii -P-cbou "$scratch/abbe.1")
for text in "abbe query ior MATERIAL --at NM\[,NM...\] \[OPTION...\]" "--seed N" "exit with 70" "ABBE_DATA"; do
  grep -qe "$text" <<<"$page" || fail "the manual page does not show $text"
done
