#!/usr/bin/env bash
# Three narrow filters and a chart: the commands of narrow_filters.md.
set -euo pipefail

# A filter wheel: each channel is an exposure of its own, as long as the lamp and the sensor need at its wavelength.
wheel='{"R": {"filters": [{"band": [605, 615]}], "exposure_s": 0.13}, "G": {"filters": [{"band": [535, 545]}], "exposure_s": 0.3},
  "B": {"filters": [{"band": [445, 455]}], "exposure_s": 0.7}}'
sensor='{"model": "ccd_kaf3200me_mono", "resolution": [192, 128], "pixel_pitch_um": 9.56, "quantum_efficiency": "kodak_kaf-3200me"'
card='/shapes=[{"quad": {"corner": [-200, -150, 0], "edge_u": [400, 0, 0], "edge_v": [0, 300, 0]}, "material": "card"}]'

abbe convert data/scenes/colour_bench.json --set '/lights/0/emission/illuminant="LED-B1"' --set "/sensor=$sensor, \"channels\": $wheel}" -o narrow.json
abbe render narrow.json -o chart.exr --quiet
abbe render narrow.json --set "$card" -o flat.exr --quiet

abbe develop chart.exr -o chart.tif --display chart.png
abbe develop flat.exr -o flat.tif
abbe measure chart.tif --chart narrow.json --flat flat.tif -o patches.csv

abbe calibrate --measured patches.csv --illuminant LED-B1 -o narrow --json >found.json
abbe calibrate --camera box:445-455,535-545,605-615 --illuminant LED-B1 --bits 0 --json >limit.json
abbe calibrate --camera box:445-455,535-545,605-615 --illuminant D65 --bits 0 --json >daylight.json
