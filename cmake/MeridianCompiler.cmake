# Warnings, sanitizers and coverage, alike for every target of the project.

set(MERIDIAN_SANITIZE "" CACHE STRING "Sanitizers to build with, as for -fsanitize= (for example address,undefined)")
option(MERIDIAN_COVERAGE "Instrument for coverage" OFF)

find_program(MERIDIAN_CCACHE ccache)
if(MERIDIAN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${MERIDIAN_CCACHE})
endif()

add_library(meridian-compiler INTERFACE)
target_compile_options(meridian-compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Woverloaded-virtual -Werror
  # GCC 12 warns of overlapping copies within its own std::string (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # Geometry is checked against other libraries to the last bits: no contraction behind our back.
  -ffp-contract=off)
target_compile_definitions(meridian-compiler INTERFACE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR)

if(MERIDIAN_SANITIZE)
  add_compile_options(-fsanitize=${MERIDIAN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${MERIDIAN_SANITIZE})
  # Checks multiply the code, and what -O2 and full debug information cost with it: this builds in half the time.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
  # Instrumented, GCC 12 takes a moved std::variant for uninitialised: it loses track of which alternative is set.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(MERIDIAN_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()
