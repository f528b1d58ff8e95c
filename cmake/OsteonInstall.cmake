# find_package(osteon) for programs that use the library: see examples/.
include(CMakePackageConfigHelpers)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/osteon DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT osteonTargets NAMESPACE osteon:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/osteon)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/osteonConfig.cmake.in ${PROJECT_BINARY_DIR}/osteonConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/osteon)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/osteonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/osteonConfig.cmake ${PROJECT_BINARY_DIR}/osteonConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/osteon)
if(EXISTS ${PROJECT_SOURCE_DIR}/models)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/models DESTINATION ${CMAKE_INSTALL_DATADIR}/osteon)
endif()
