# `cmake --install`: headers and libraries of every module, the command, find_package(lodestone) and pkg-config.
include(CMakePackageConfigHelpers)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lodestone)
install(FILES lodestone/lodestone.h lodestone/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestone)
install(EXPORT lodestone-targets NAMESPACE lodestone:: DESTINATION ${config_dir})
configure_package_config_file(cmake/lodestone-config.cmake.in ${PROJECT_BINARY_DIR}/lodestone-config.cmake
  INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lodestone-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lodestone-config.cmake ${PROJECT_BINARY_DIR}/lodestone-config-version.cmake
  DESTINATION ${config_dir})

# pkg-config. The modules are static libraries, so all they need is listed, upper modules before lower ones.
set(pc_libs "")
get_property(modules GLOBAL PROPERTY LODESTONE_MODULES)  # in the order of lodestone/CMakeLists.txt: lower ones first
foreach(module IN LISTS modules)
  get_target_property(type lodestone_${module} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    string(PREPEND pc_libs "-llodestone_${module} ")
  endif()
endforeach()
set(pc_requires "fmt zlib libpng libturbojpeg libwebp")
if(NOT LODESTONE_STD_THREADS)
  string(APPEND pc_requires " tbb")
endif()
if(LODESTONE_WITH_DRACO)
  string(APPEND pc_requires " draco")
endif()
if(LODESTONE_WITH_ASSIMP)
  string(APPEND pc_requires " assimp")
endif()
if(LODESTONE_WITH_MESHOPT)
  string(APPEND pc_libs "-lmeshoptimizer")  # comes without a file for pkg-config
endif()
file(RELATIVE_PATH to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)  # the installed tree may be moved
string(REGEX REPLACE "/$" "" to_prefix ${to_prefix})
if(LODESTONE_WITH_ITK)
  string(APPEND pc_libs " ${LODESTONE_ITK_LINK}")  # comes without a file for pkg-config, too
endif()
configure_file(cmake/lodestone.pc.in ${PROJECT_BINARY_DIR}/lodestone.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lodestone.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
