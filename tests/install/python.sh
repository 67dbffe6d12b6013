# The package of Python: beside the program, at night also in a Debian package of its own and as pip installs it without a network; each of them
# renders.
. "$(dirname "$0")/check.sh"
[ -d "$ABBE_BUILD/python" ] || { echo "no package for Python in this build"; exit 77; }
version=$(sed -n 's/^version: //p' "$ABBE_SOURCE/CITATION.cff")
cat >"$scratch/try.py" <<'END'
import sys
import abbe
scene = abbe.Scene(sys.argv[1])
film = abbe.render(scene, spp=1)
film.write(sys.argv[2])
film.write("film.png")
print(abbe.__version__, abbe.__file__, round(abbe.ior("N-BK7", 587.5618), 6))
END
works() {  # PYTHON FOLDER
  equal "what the package of $2 says" "$(cd "$scratch" && "$1" -B try.py "$ABBE_SOURCE/data/scenes/furnace.json" film.exr)" "$version $2/abbe/__init__.py 1.5168"
}

install_to "$scratch/first"
mv "$scratch/first" "$scratch/abbe"
PYTHONPATH=$scratch/abbe/lib/python3/dist-packages works /usr/bin/python3 "$scratch/abbe/lib/python3/dist-packages"
mv "$scratch/film.exr" "$scratch/first.exr"
nightly || exit 0

(cd "$ABBE_BUILD" && cpack -G DEB -B "$scratch" >"$scratch/cpack.log" 2>&1) || fail "cpack: $(tail -5 "$scratch/cpack.log")"
package=$scratch/python3-abbe_${version}_amd64.deb
depends=$(dpkg-deb -f "$package" Depends)
for needed in "abbe (= $version)" python3-numpy "python3 (>= 3.11)" "python3 (<< 3.12)" libembree3-3; do
  contains "Depends" "$depends" "$needed"
done
equal "files outside dist-packages" "$(dpkg-deb -c "$package" | awk '{print $6}' | grep -v '/$' | grep -v '^./usr/lib/python3/dist-packages/abbe/' || true)" ""
for deb in "$package" "$scratch/abbe_${version}_amd64.deb"; do dpkg-deb -x "$deb" "$scratch/root"; done
PYTHONPATH=$scratch/root/usr/lib/python3/dist-packages works /usr/bin/python3 "$scratch/root/usr/lib/python3/dist-packages"

/usr/bin/python3 -m venv --system-site-packages "$scratch/venv"
(cd "$ABBE_SOURCE" && "$scratch/venv/bin/pip" install --quiet --no-index --config-settings "build-dir=$ABBE_BUILD" . 2>"$scratch/pip.log") ||
  fail "pip: $(tail -5 "$scratch/pip.log")"
works "$scratch/venv/bin/python" "$scratch/venv/lib/python3.11/site-packages"
cmp "$scratch/film.exr" "$scratch/first.exr" || fail "the package of pip renders other bits"
contains "what pip says" "$("$scratch/venv/bin/pip" show abbe)" "Version: $version"
grep -rqF "$ABBE_SOURCE" "$scratch/venv/lib/python3.11/site-packages/abbe" && fail "the package holds the path of the source tree"
exit 0
