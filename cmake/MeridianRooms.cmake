# A room is one folder of the house and one static library.
#
# Each target has an include folder of its own, in the build tree, that holds one link: to its room. So an
# #include "globebrowsing/tiling/tile_index.h" compiles only in targets that link globebrowsing-tiling, and an include
# that runs upwards does not compile.

# meridian_room(TARGET PATH SOURCES... [LINKS...] [PRIVATE_LINKS...] [OPENGL])
#   PATH           what includes of this room begin with: host/api, globebrowsing/tiling, ...
#   LINKS          rooms and libraries that the room's headers include
#   PRIVATE_LINKS  rooms and libraries that only its sources include
#   OPENGL         the room may include OpenGL; without it such an include is an error
function(meridian_room TARGET PATH)
  cmake_parse_arguments(ROOM "OPENGL" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(${TARGET} STATIC ${ROOM_SOURCES})
  add_library(Meridian::${TARGET} ALIAS ${TARGET})
  target_link_libraries(${TARGET} PUBLIC ${ROOM_LINKS} PRIVATE $<BUILD_INTERFACE:meridian-compiler> ${ROOM_PRIVATE_LINKS})
  meridian_link_room(${TARGET} ${PATH} ${CMAKE_CURRENT_SOURCE_DIR})
  target_include_directories(${TARGET} PUBLIC $<INSTALL_INTERFACE:include/meridian>)
  target_compile_features(${TARGET} PUBLIC cxx_std_20)
  if(NOT ROOM_OPENGL)
    target_include_directories(${TARGET} BEFORE PRIVATE ${PROJECT_SOURCE_DIR}/cmake/no_opengl)
  endif()
  set_property(GLOBAL APPEND PROPERTY MERIDIAN_ROOMS ${TARGET})
  file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  install(FILES ${headers} DESTINATION include/meridian/${PATH})
endfunction()

# Gives TARGET the include folder through which others see FOLDER as PATH.
function(meridian_link_room TARGET PATH FOLDER)
  set(root ${PROJECT_BINARY_DIR}/include/${TARGET})
  get_filename_component(parent ${root}/${PATH} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${FOLDER} ${root}/${PATH} SYMBOLIC)
  target_include_directories(${TARGET} PUBLIC $<BUILD_INTERFACE:${root}>)
endfunction()

# meridian_test(NAME SOURCES... LINKS... [LABELS...]): one GoogleTest program, its cases known to CTest.
function(meridian_test NAME)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINKS;LABELS" ${ARGN})
  add_executable(${NAME} ${TEST_SOURCES})
  target_link_libraries(${NAME} PRIVATE meridian-compiler ${TEST_LINKS} GTest::gmock_main)
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${NAME} PRIVATE MERIDIAN_SOURCE_FOLDER="${PROJECT_SOURCE_DIR}")
  set(properties TIMEOUT 300)
  if(TEST_LABELS)
    list(APPEND properties LABELS "${TEST_LABELS}")
  endif()
  # Five seconds, the default, are little for a program that a busy machine reads from the disk for the first time.
  gtest_discover_tests(${NAME} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES ${properties})
endfunction()

# meridian_benchmark(NAME SOURCES... LINKS...): one Google Benchmark program, run by scripts/bench.
function(meridian_benchmark NAME)
  cmake_parse_arguments(BENCH "" "" "SOURCES;LINKS" ${ARGN})
  if(NOT MERIDIAN_BENCHMARKS)
    return()
  endif()
  add_executable(${NAME} ${BENCH_SOURCES})
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${NAME} PRIVATE meridian-compiler ${BENCH_LINKS} benchmark::benchmark_main)
endfunction()

# Adds those of the folders that are there.
macro(meridian_add_rooms)
  foreach(room ${ARGN})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${room}/CMakeLists.txt)
      add_subdirectory(${room})
    endif()
  endforeach()
endmacro()
