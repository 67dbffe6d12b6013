A=/work/main/build/release/cli/abbe
$A render /work/main/data/scenes/colour_bench.json -o film.exr --spp 16 --quiet --set '/sensor/resolution=[96,64]'
