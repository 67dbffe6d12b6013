# A project outside the tree finds the installed package and builds against it; at night it also renders the bits that the installed program renders.
. "$(dirname "$0")/check.sh"
install_to "$scratch/first"
mv "$scratch/first" "$scratch/abbe"
grep -rqF "$ABBE_SOURCE" "$scratch/abbe/lib/cmake" && fail "the package holds the path of the source tree"
cp -r "$ABBE_SOURCE/tests/install/consumer" "$scratch/consumer"
cd "$scratch/consumer"
cmake -S . -B build -DCMAKE_PREFIX_PATH="$scratch/abbe" -DCMAKE_BUILD_TYPE=Release >configure.log || fail "configure: $(<configure.log)"
cmake --build build --target index >build.log 2>&1 || fail "build: $(tail -20 build.log)"
equal "index of N-BK7" "$(build/index)" "n_d of N-BK7: 1.516800"
nightly || exit 0  # the headers of a render take the compiler ten times as long

cmake --build build >build.log 2>&1 || fail "build: $(tail -20 build.log)"
scene="$scratch/abbe/share/abbe/data/scenes/furnace.json"
equal "index of N-BK7" "$(build/consumer "$scene" consumer.exr consumer.png)" "n_d of N-BK7: 1.516800"
"$scratch/abbe/bin/abbe" render "$scene" --quiet -o tool.exr
contains "same bits" "$("$scratch/abbe/bin/abbe" compare consumer.exr tool.exr --json)" '"relMSE":0.0,"rmse":0.0,"mean_ratio":1.0,'
[ -s consumer.png ] || fail "no picture"  # of whose pixels the other tests tell
