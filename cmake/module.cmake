# Compile options shared by everything of ours, and the helpers that make a module (a library target) and its tests.

add_library(lodestone_options INTERFACE)
target_compile_options(lodestone_options INTERFACE
  -Wall -Wextra -Wconversion
  $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow>  # of files that are joined, private names hide each other
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>  # private types, in what seems a header
  $<$<BOOL:${LODESTONE_WERROR}>:-Werror>
  # g++ 12 sees overlaps in std::string that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # The same bytes on every machine: no fused multiply-add unless it is written down.
  -ffp-contract=off)
target_include_directories(lodestone_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)

# Where a preset joins files to compile them faster (CMAKE_UNITY_BUILD), those of one folder are joined, at most eight at a time.
# `alone`: files and folders whose files stay by themselves, as they have private names that others have too.
function(lodestone_join_files target files alone)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  foreach(file IN LISTS files)
    cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE name)
    cmake_path(GET name PARENT_PATH folder)
    if(name IN_LIST alone OR folder IN_LIST alone)
      continue()
    endif()
    string(MAKE_C_IDENTIFIER "${target}_${folder}" group)
    if(NOT DEFINED count_${group})
      set(count_${group} 0)
    endif()
    math(EXPR part "${count_${group}} / 8")
    math(EXPR count_${group} "${count_${group}} + 1")
    set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${group}_${part})
  endforeach()
endfunction()

# lodestone_module(name DEPENDS module... [LIBRARIES target...] [ALONE file...]): target lodestone_<name> from the files of
# lodestone/<name> and its folders. ALONE: see lodestone_join_files.
function(lodestone_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES;DEFINITIONS;ALONE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  list(FILTER headers EXCLUDE REGEX "_detail\\.h$")
  set(target lodestone_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:lodestone_options> ${ARG_LIBRARIES})
    target_compile_definitions(${target} PRIVATE ${ARG_DEFINITIONS})
    lodestone_join_files(${target} "${sources}" "${ARG_ALONE}")
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(lodestone::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} ${scope} cxx_std_20)
  foreach(module IN LISTS ARG_DEPENDS)
    target_link_libraries(${target} ${scope} lodestone_${module})
  endforeach()
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestone/${name}/${folder})
  endforeach()
  install(TARGETS ${target} EXPORT lodestone-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set_property(GLOBAL APPEND PROPERTY LODESTONE_MODULES ${name})
endfunction()

# lodestone_tests(module [LIBRARIES target...] [ALONE file...] [THREADS]): executable <module>_tests from
# tests/<module> and its folders, label "unit", or with THREADS "unit-threads": the thread sanitizer looks at those, too.
# ALONE: see lodestone_join_files.
function(lodestone_tests module)
  cmake_parse_arguments(ARG "THREADS" "" "LIBRARIES;ALONE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${module}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${module}_tests ${sources})
  target_link_libraries(${module}_tests PRIVATE lodestone_options lodestone_${module} lodestone_test_support GTest::gtest
                        ${ARG_LIBRARIES})
  list(TRANSFORM ARG_ALONE PREPEND ${module}/)
  lodestone_join_files(${module}_tests "${sources}" "${ARG_ALONE}")
  add_dependencies(unit_tests ${module}_tests)
  set(label unit)
  if(ARG_THREADS)
    set(label unit-threads)  # ctest -L looks for a part of it
    add_dependencies(thread_tests ${module}_tests)
  endif()
  gtest_discover_tests(${module}_tests TEST_PREFIX "${module}." PROPERTIES LABELS ${label} DISCOVERY_TIMEOUT 60)
endfunction()
