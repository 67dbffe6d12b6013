#!/usr/bin/env bash
# A Bayer camera and its noise: the commands of bayer_noise.md.
set -euo pipefail

abbe render data/scenes/colour_bench.json --spp 16 -o bench.exr --quiet

# Dark frames of two times, and even light from a tenth of what saturates to beyond it; two of each.
for seconds in 0.001 10; do
  abbe develop bench.exr --iso 400 --frame dark --exposure-s $seconds --frames 2 -o dark_$seconds.tif
done
for share in 0.1 0.3 0.6 1.5; do
  abbe develop bench.exr --iso 400 --frame flat:$share --frames 2 -o flat_$share.tif
done
abbe transfer --dark dark_*.tif --lit flat_*.tif --plot transfer.svg --json >transfer.json

abbe develop bench.exr --exposure-s 0.2 --iso 100 -o iso100.dng --json >iso100.json
abbe develop bench.exr --exposure-s 0.0125 --iso 1600 -o iso1600.dng --json >iso1600.json
