# abbe_room(<name> SOURCES ... [LINKS <rooms and header libraries>...] [HIDES <third parties>...])
#
# LINKS are the room's allowed edges (public); HIDES are the third parties whose headers stay inside the room.
function(abbe_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;HIDES" ${ARGN})
  add_library(abbe_${name} STATIC ${ROOM_SOURCES})
  add_library(abbe::${name} ALIAS abbe_${name})
  # One machine code for programs and for the module of Python, so that both give the same bits.
  set_target_properties(abbe_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(abbe_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/abbe>)
  target_compile_features(abbe_${name} PUBLIC cxx_std_20)
  # Headers pass packets of wavelengths as vectors of this family, so programs that link the installed room must be built for it.
  target_compile_options(abbe_${name} INTERFACE $<INSTALL_INTERFACE:-march=x86-64-v3>)
  target_link_libraries(abbe_${name} PUBLIC ${ROOM_LINKS} PRIVATE ${ROOM_HIDES})
  abbe_compile_options(abbe_${name})
endfunction()

# abbe_module(<name> SOURCES ... LINKS <third parties>...)
#
# A library that a program opens while it runs (io/module.h), as it is needed seldom or there on few machines. Its name holds the version, so that
# a program never opens that of another.
function(abbe_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINKS" ${ARGN})
  add_library(abbe_${name} MODULE ${MODULE_SOURCES})
  set_target_properties(abbe_${name} PROPERTIES PREFIX "" OUTPUT_NAME "abbe_${name}-${PROJECT_VERSION}" CXX_VISIBILITY_PRESET hidden INSTALL_RPATH ""
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/${ABBE_MODULE_DIR}")
  target_include_directories(abbe_${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(abbe_${name} PRIVATE ${MODULE_LINKS})
  abbe_compile_options(abbe_${name})
endfunction()

# Warnings and the CPU family for one target; every build of one machine family gives the same bits. GCC 12 warns of overlapping copies in
# `"literal" + std::string` where there are none (GCC bug 105651), so -Wrestrict is off. Nothing traps floating-point exceptions or reads errno,
# and saying so turns branches in loops over wavelengths into selections on whole vectors; values do not change. GCC copies structs in pieces of
# 16 bytes unless told otherwise, and loading a vector of 32 after storing it in two pieces waits for memory. It looks for garbage of its own beyond 1 GB
# only, which saves a seventh of its time.
function(abbe_common_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-restrict -march=x86-64-v3 -fno-math-errno
    -fno-trapping-math $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-mmove-max=256 -mstore-max=256 --param=ggc-min-heapsize=1000000>)
endfunction()

# For what leaves the doing to rooms, as tests do and what reads the options of commands: up to half the time of their compilation would be optimisation that
# nobody waits for. A function of a header that such a target calls rather than inlines is this one's for the whole program, so that commands
# and the module of Python, whose bits are compared, are compiled as rooms are.
function(abbe_plain_options target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Those and the build's sanitizers, for all that is not a test; rooms that no path comes through have the build's options for these besides, as
# they take most of the time to compile and are seldom waited for. Rooms that paths come through are inlined as far as GCC does small sources: it
# stops where the sources of a room, compiled as one, have grown by 40 %.
function(abbe_compile_options target)
  abbe_common_options(${target})
  if(target MATCHES "^abbe(_commands)?$")
    abbe_plain_options(${target})
  endif()
  target_compile_options(${target} PRIVATE ${ABBE_SANITIZERS})
  set(traced abbe_sampling abbe_spectral abbe_materials abbe_lens abbe_sensor abbe_scene abbe_transport)
  if(target IN_LIST traced)
    target_compile_options(${target} PRIVATE $<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:--param=inline-unit-growth=400 --param=large-unit-insns=200000
      --param=large-function-growth=400 --param=large-function-insns=10000 --param=max-inline-insns-auto=100>)
  else()
    target_compile_options(${target} PRIVATE ${ABBE_SANITIZERS_OFF_PATHS})
  endif()
endfunction()
