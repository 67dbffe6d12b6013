# `cpack -G DEB` in the build folder makes the Debian package: component `tool`, laid out for /usr.
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
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};abbe;tool;/")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
