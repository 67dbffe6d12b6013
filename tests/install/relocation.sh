# An installation works where it was moved to, however it is called, from its own tables alone.
. "$(dirname "$0")/check.sh"
install_to "$scratch/first"
mv "$scratch/first" "$scratch/second place"
program="$scratch/second place/bin/abbe"
data="$scratch/second place/share/abbe/data"

cd /
check_program "$program" "$data"
mkdir "$scratch/path"
ln -s "../second place/bin/abbe" "$scratch/path/abbe"
equal "data folder through a link on PATH" "$(PATH="$scratch/path:$PATH" abbe --version | sed -n 's/^data //p')" "$data"

for file in share/man/man1/abbe.1.gz share/bash-completion/completions/abbe share/doc/abbe/reference/commands.md share/doc/abbe/copyright; do
  [ -s "$scratch/second place/$file" ] || fail "$file is not installed"
done
contains "manual page" "$(zcat "$scratch/second place/share/man/man1/abbe.1.gz")" ".TH ABBE 1 "

# Pictures other than PNGs need the module that lies beside the program; the film does not, nor does anything else.
with_picture() { "$program" render "$data/scenes/furnace.json" --spp 2 --quiet -o "$scratch/film.exr" --display "$scratch/film.jpg"; }
with_picture
[ -s "$scratch/film.jpg" ] || fail "no picture"
rm "$scratch/film.exr"
mv "$scratch/second place/lib/abbe" "$scratch/modules"
code=0
message=$(with_picture 2>&1) || code=$?
equal "exit code without the module of pictures" "$code" 4
contains "message without the module" "$message" "the module that reads and writes pictures does not load: abbe_pictures-"
[ -s "$scratch/film.exr" ] || fail "no film without the module"
message=$("$program" measure "$scratch/film.exr" --chart colorchecker24_after_nov2014 --corners find 2>&1) || true
contains "message without the module" "$message" "the chart detector, which is part of Abbe if it was built with OpenCV, does not load: abbe_charts-"

# What the tables here say is what it says, and without them it says so; it cannot know the source tree's.
sed -i 's/SCHOTT Zemax catalog/moved tables/' "$data/glass/dielectrics.csv"
contains "changed table" "$("$program" query ior N-BK7 --at 550 --json)" "moved tables"
mv "$data" "$scratch/hidden"
code=0
message=$("$program" query ior N-BK7 --at 550 2>&1) || code=$?
equal "exit code without tables" "$code" 4
contains "message without tables" "$message" "share/abbe/data: the tables are missing; set ABBE_DATA to their folder"
contains "tables of ABBE_DATA" "$(ABBE_DATA="$scratch/hidden" "$program" query ior N-BK7 --at 550 --json)" "moved tables"
grep -qF "$ABBE_SOURCE" "$program" && fail "the program holds the path of the source tree"
exit 0
