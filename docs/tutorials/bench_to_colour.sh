#!/usr/bin/env bash
# From a bench to calibrated colour: the commands of bench_to_colour.md.
set -euo pipefail

abbe draw data/scenes/colour_bench.json -o bench.svg
abbe render data/scenes/colour_bench.json -o chart.exr --quiet
abbe render data/scenes/colour_bench.json -o flat.exr --quiet \
  --set '/shapes=[{"quad": {"corner": [-200, -150, 0], "edge_u": [400, 0, 0], "edge_v": [0, 300, 0]}, "material": "card"}]'

abbe develop chart.exr -o chart.dng
abbe develop flat.exr -o flat.dng
abbe develop chart.exr --display chart.png

abbe measure chart.dng --chart data/scenes/colour_bench.json -o uneven.csv
abbe measure chart.dng --chart data/scenes/colour_bench.json --flat flat.dng -o patches.csv

abbe calibrate --measured uneven.csv --json >uneven.json
abbe calibrate --measured patches.csv -o nikon --json >found.json
abbe calibrate --camera Nikon_D5100 --bits 0 --json >limit.json
