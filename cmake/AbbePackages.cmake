# What the installed libraries link, as Debian 12 packages it; read by the build and by the installed package. OpenColorIO has no CMake config
# there and comes through pkg-config.
set(Abbe_PACKAGES "Threads" "fmt" "Imath" "OpenEXR" "OpenSSL" "PNG" "embree 3" "Ceres" "pugixml" "TinyGLTF" "tinyobjloader" "yaml-cpp" "ZLIB" "PkgConfig")
set(Abbe_PKGCONFIG OpenColorIO)
