# The parts we stand on, each as an imported target. Included by the project and by its installed package.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(GDAL REQUIRED)
find_package(pugixml REQUIRED)

# meridian_pkg_config(NAME MODULE): the imported target PkgConfig::NAME.
macro(meridian_pkg_config NAME MODULE)
  if(NOT TARGET PkgConfig::${NAME})
    pkg_check_modules(${NAME} REQUIRED IMPORTED_TARGET GLOBAL ${MODULE})
  endif()
endmacro()

meridian_pkg_config(ERFA erfa)
meridian_pkg_config(GEOGRAPHICLIB geographiclib)
# The build that throws C++ exceptions: a Lua error then unwinds our frames.
meridian_pkg_config(LUA lua5.4-c++)
if(MERIDIAN_GRAPHICS)
  meridian_pkg_config(EPOXY epoxy)
  meridian_pkg_config(EGL egl)
  meridian_pkg_config(GLFW glfw3)
  meridian_pkg_config(IMGUI imgui)
  meridian_pkg_config(PNG libpng)
  meridian_pkg_config(FFMPEG "libavcodec;libavformat;libavutil;libswscale")
endif()

# GLM is headers only; Debian's package has no imported target that keeps our include order.
find_path(MERIDIAN_GLM_INCLUDE glm/glm.hpp REQUIRED)

if(MERIDIAN_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(MERIDIAN_TESTS AND MERIDIAN_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
