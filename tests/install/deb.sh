# The Debian package has its name, at night what it depends on, and a program that runs from where it is unpacked.
. "$(dirname "$0")/check.sh"
cd "$ABBE_BUILD"
quick=(-D CPACK_DEBIAN_PACKAGE_SHLIBDEPS=OFF -D CPACK_DEBIAN_COMPRESSION_TYPE=zstd)  # to find the libraries that it needs takes most of a minute
nightly && quick=()
cpack -G DEB -B "$scratch" "${quick[@]}" >"$scratch/cpack.log" 2>&1 || fail "cpack: $(tail -5 "$scratch/cpack.log")"
package=$scratch/abbe_$(sed -n 's/^version: //p' "$ABBE_SOURCE/CITATION.cff")_amd64.deb
[ -f "$package" ] || fail "no $package"

for field in Package=abbe Architecture=amd64 Section=graphics; do
  equal "${field%=*}" "$(dpkg-deb -f "$package" "${field%=*}")" "${field#*=}"
done
depends=$(dpkg-deb -f "$package" Depends)
nightly && for library in libc6 libembree3-3 libopenexr-3-1-30 libopenimageio2.4 libopencolorio2.1 libpugixml1v5 libtinygltf2d libtinyobjloader2rc10 libfmt9 libssl3 zlib1g; do
  contains "Depends" ", $depends" ", $library"
done
files=$(dpkg-deb -c "$package" | awk '{print $6}')
for file in bin/abbe lib/abbe/abbe_pictures- share/abbe/data/glass/dielectrics.csv share/abbe/blender/abbe_export.py share/man/man1/abbe.1.gz share/bash-completion/completions/abbe share/doc/abbe/copyright; do
  contains "files" "$files" "./usr/$file"
done
others=$(grep -vE '^\./(usr/((bin|share)/.*|lib/(abbe/.*)?)?)?$' <<<"$files" || true)
equal "files outside usr/bin, usr/lib/abbe and usr/share" "$others" ""

dpkg-deb -x "$package" "$scratch/root"
if command -v mpirun >/dev/null; then
  mpi=${package/abbe_/abbe-mpi_}
  contains "Depends of abbe-mpi" "$(dpkg-deb -f "$mpi" Depends)" "abbe (= $(dpkg-deb -f "$package" Version))"
  contains "files of abbe-mpi" "$(dpkg-deb -c "$mpi")" "./usr/lib/abbe/abbe_mpi-"
  equal "package with the module of MPI" "$(grep -c abbe_mpi <<<"$files" || true)" 0
fi
charts=${package/abbe_/abbe-charts_}
if [ -f "$ABBE_BUILD"/lib/abbe/abbe_charts-*.so ]; then
  nightly && contains "Depends of abbe-charts" "$(dpkg-deb -f "$charts" Depends)" "libopencv-contrib"
  contains "files of abbe-charts" "$(dpkg-deb -c "$charts")" "./usr/lib/abbe/abbe_charts-"
  equal "package with the module of charts" "$(grep -c abbe_charts <<<"$files" || true)" 0
fi
cd /
check_program "$scratch/root/usr/bin/abbe" "$scratch/root/usr/share/abbe/data"
if nightly && command -v lintian >/dev/null; then
  errors=$(lintian --allow-root --fail-on none "$package" | grep '^E:' || true)
  equal "errors of lintian" "$errors" ""
fi
