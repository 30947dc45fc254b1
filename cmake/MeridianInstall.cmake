# The install tree: libraries, headers, data and the package that find_package(Meridian) finds.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

get_property(rooms GLOBAL PROPERTY MERIDIAN_ROOMS)
install(TARGETS ${rooms} EXPORT MeridianTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT MeridianTargets NAMESPACE Meridian:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Meridian)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/MeridianConfig.cmake.in
  ${PROJECT_BINARY_DIR}/MeridianConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Meridian)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/MeridianConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/MeridianConfig.cmake ${PROJECT_BINARY_DIR}/MeridianConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/MeridianDependencies.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Meridian)
install(DIRECTORY shaders data DESTINATION ${CMAKE_INSTALL_DATADIR}/meridian)
if(TARGET meridian)
  install(TARGETS meridian RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
