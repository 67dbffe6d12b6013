# Third parties: what the libraries link, and what only building needs.
option(BUILD_TESTING "Build the tests" OFF)
include(AbbePackages)
foreach(package ${Abbe_PACKAGES})
  separate_arguments(package)
  find_package(${package} REQUIRED)
endforeach()
# OpenImageIO's CMake config demands its tools package and OpenCV headers.
foreach(module ${Abbe_PKGCONFIG} OpenImageIO libtiff-4 cfitsio cpp-httplib)
  pkg_check_modules(${module} REQUIRED IMPORTED_TARGET ${module})
endforeach()
find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp REQUIRED)
find_package(RapidJSON REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(MPI QUIET COMPONENTS CXX)  # for the module by which processes render together
# For the module that finds charts. OpenCV's CMake config is in a package that brings all of it.
find_path(OPENCV_INCLUDE_DIR opencv2/mcc.hpp PATH_SUFFIXES opencv4)
foreach(part calib3d core imgproc mcc)
  string(TOUPPER ${part} PART)
  find_library(OPENCV_${PART}_LIBRARY opencv_${part})
endforeach()
# For the package of Python: Debian's own, unless another is named.
set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the package abbe is for")
find_package(Python QUIET COMPONENTS Interpreter Development.Module)
if(Python_FOUND)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
# Ceres is a static library of templates of Eigen compiled for any x86-64, where memory is aligned to 16 bytes. With
# AVX Eigen would align to 32, and under AddressSanitizer align memory itself: functions of one compilation would be linked into the other and crash.
set_property(TARGET Ceres::ceres Eigen3::Eigen APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=1)
if(BUILD_TESTING)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
endif()
