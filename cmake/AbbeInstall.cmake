# What `cmake --install` puts where. Component `tool` is all that running Abbe needs, `development` what programs linking its libraries need.
include(CMakePackageConfigHelpers)
set(ABBE_DATA_INSTALL_DIR "${CMAKE_INSTALL_DATADIR}/abbe/data")
set(ABBE_PACKAGE_INSTALL_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/Abbe")
set(ABBE_PUBLIC_ROOMS io sampling spectral materials lens sensor scene description importers transport calibration develop results)

install(TARGETS abbe DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT tool)
install(TARGETS abbe_pictures DESTINATION "${ABBE_MODULE_DIR}" COMPONENT tool)
foreach(module mpi charts)  # each a package of its own
  if(TARGET abbe_${module})
    install(TARGETS abbe_${module} DESTINATION "${ABBE_MODULE_DIR}" COMPONENT ${module})
  endif()
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/data/" DESTINATION "${ABBE_DATA_INSTALL_DIR}" COMPONENT tool)
install(FILES python/blender/abbe_export.py DESTINATION "${CMAKE_INSTALL_DATADIR}/abbe/blender" COMPONENT tool)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT tool)
install(FILES CITATION.cff cmake/copyright DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT tool)

# The program describes itself; Debian wants what describes it compressed.
set(ABBE_DESCRIPTIONS "${PROJECT_BINARY_DIR}/share/abbe.1.gz" "${PROJECT_BINARY_DIR}/share/abbe.bash"
  "${PROJECT_BINARY_DIR}/share/changelog.gz")
add_custom_command(OUTPUT ${ABBE_DESCRIPTIONS}
  COMMAND sh -c "$<TARGET_FILE:abbe> help --format man | gzip -9n >share/abbe.1.gz"
  COMMAND sh -c "$<TARGET_FILE:abbe> help --format bash >share/abbe.bash"
  COMMAND sh -c "gzip -9nc '${PROJECT_SOURCE_DIR}/CHANGELOG.md' >share/changelog.gz"
  DEPENDS abbe CHANGELOG.md WORKING_DIRECTORY "${PROJECT_BINARY_DIR}" VERBATIM)
add_custom_target(descriptions ALL DEPENDS ${ABBE_DESCRIPTIONS})
add_custom_target(reference COMMAND sh -c "$<TARGET_FILE:abbe> help --format markdown >docs/reference/commands.md"
  COMMAND sh -c "$<TARGET_FILE:write_schema> >docs/reference/scene.schema.json"
  COMMAND sh -c "$<TARGET_FILE:write_schema> docs/reference/scene.md >docs/reference/scene.md.new && mv docs/reference/scene.md.new docs/reference/scene.md"
  DEPENDS abbe write_schema WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" VERBATIM)
install(FILES "${PROJECT_BINARY_DIR}/share/abbe.1.gz" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT tool)
install(FILES "${PROJECT_BINARY_DIR}/share/abbe.bash" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME abbe
  COMPONENT tool)
install(FILES "${PROJECT_BINARY_DIR}/share/changelog.gz" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT tool)

foreach(room ${ABBE_PUBLIC_ROOMS})
  set_target_properties(abbe_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS abbe_${room} EXPORT AbbeTargets DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/${room}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/abbe" COMPONENT development
    FILES_MATCHING PATTERN "*.h")
endforeach()
install(EXPORT AbbeTargets NAMESPACE Abbe:: DESTINATION "${ABBE_PACKAGE_INSTALL_DIR}" COMPONENT development)
configure_package_config_file(cmake/AbbeConfig.cmake.in "${PROJECT_BINARY_DIR}/AbbeConfig.cmake"
  INSTALL_DESTINATION "${ABBE_PACKAGE_INSTALL_DIR}" PATH_VARS ABBE_DATA_INSTALL_DIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/AbbeConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/AbbeConfig.cmake" "${PROJECT_BINARY_DIR}/AbbeConfigVersion.cmake" cmake/AbbePackages.cmake
  DESTINATION "${ABBE_PACKAGE_INSTALL_DIR}" COMPONENT development)

# Programs of the build folder find the source tree's data by the rule of installed ones.
foreach(folder "${PROJECT_BINARY_DIR}" "${PROJECT_BINARY_DIR}/tests")
  file(MAKE_DIRECTORY "${folder}/share/abbe")
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/data" "${folder}/share/abbe/data" SYMBOLIC)
endforeach()
