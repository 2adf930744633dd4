# `cmake --install`: headers and libraries of every room, the command, find_package(lodestone) and pkg-config.
include(CMakePackageConfigHelpers)

install(EXPORT lodestone-targets NAMESPACE lodestone:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lodestone)
configure_package_config_file(cmake/lodestone-config.cmake.in ${PROJECT_BINARY_DIR}/lodestone-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lodestone)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lodestone-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lodestone-config.cmake ${PROJECT_BINARY_DIR}/lodestone-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lodestone)
