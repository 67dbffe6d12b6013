# `cpack -G DEB` in the build folder makes the Debian packages, laid out for /usr: `abbe` of component `tool`; `abbe-mpi`, where there is
# Open MPI; `abbe-charts`, where there is OpenCV's detector of charts; and `python3-abbe`, where there is pybind11.
set(CPACK_PACKAGE_NAME abbe)
set(CPACK_PACKAGE_VENDOR "The Abbe developers")
set(CPACK_PACKAGE_CONTACT "The Abbe developers <abbe@packages.invalid>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "spectral renderer validated against measured colour science")
set(CPACK_PACKAGE_DESCRIPTION "Abbe follows light of sampled wavelengths through dispersive glass and
metal, counts it on a sensor behind its filters, and turns the counts into
calibrated colour.
.
It renders dispersion and prisms, simulates CCD sensors behind bandpass
filters, and checks colourimetric accuracy against references.")
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL tool)
foreach(component mpi charts python)
  if(TARGET abbe_${component})
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endif()
endforeach()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_TOOL_PACKAGE_NAME abbe)
set(CPACK_DEBIAN_MPI_PACKAGE_NAME abbe-mpi)
set(CPACK_COMPONENT_MPI_DESCRIPTION "renders one film of Abbe with several processes
This module lets mpirun start one render as several processes, of one
machine or of many; the film has the same bits whatever their number.")
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "abbe (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_CHARTS_PACKAGE_NAME abbe-charts)
set(CPACK_COMPONENT_CHARTS_DESCRIPTION "finds charts in pictures for Abbe
This module lets `abbe measure --corners find` find a ColorChecker in films,
raw files and pictures, by OpenCV.")
set(CPACK_DEBIAN_CHARTS_PACKAGE_DEPENDS "abbe (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-abbe)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "renders with Abbe from Python
The package abbe: scenes from dicts, films as arrays of numpy, indices and
colours over arrays of wavelengths.")
math(EXPR next_python "0${Python_VERSION_MINOR} + 1")  # a module is for one minor version
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "abbe (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_python})")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
