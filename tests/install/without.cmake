# Configures, builds and tries the project with a part left out.
#
# cmake -D SOURCE=... -D BINARY=... -D OPTIONS=... [-D BUILD=ON] -P without.cmake
#   OPTIONS   what to leave out: -DNAME=OFF, several parted by |
#   BUILD     also build, run the tests that are there, and give the program an asset that asks for a globe

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(output "${output}" PARENT_SCOPE)
  set(result "${result}" PARENT_SCOPE)
endfunction()

function(must)
  run(${ARGN})
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: exit ${result}\n${output}")
  endif()
endfunction()

string(REPLACE "|" ";" options "${OPTIONS}")
must(${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G Ninja -D CMAKE_BUILD_TYPE=Release ${options})
if(NOT BUILD)
  return()
endif()
must(${CMAKE_COMMAND} --build ${BINARY})
must(${CMAKE_CTEST_COMMAND} --test-dir ${BINARY} --output-on-failure --label-exclude "^long$")

if(EXISTS ${BINARY}/bin/meridian)
  must(${BINARY}/bin/meridian --version)
  must(${BINARY}/bin/meridian --validate ${SOURCE}/data/assets/sun.asset)
  run(${BINARY}/bin/meridian --validate ${SOURCE}/data/assets/earth.asset)
  if(NOT result EQUAL 3 OR NOT output MATCHES "RenderableGlobe")
    message(FATAL_ERROR "a globe without its module must be an error that says so; exit ${result}\n${output}")
  endif()
endif()
