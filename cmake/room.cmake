# Compile options shared by everything of ours, and the helpers that make a room (a library target) and its tests.

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

# lodestone_room(name DEPENDS room... [LIBRARIES target...] [ALONE file...]): target lodestone_<name> from
# lodestone/<name>/*.cpp. ALONE: files with private names that another has too; where a preset joins files to compile them
# faster (CMAKE_UNITY_BUILD) these are left by themselves.
function(lodestone_room name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES;DEFINITIONS;ALONE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  list(FILTER headers EXCLUDE REGEX "_detail\\.h$")
  set(target lodestone_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:lodestone_options> ${ARG_LIBRARIES})
    target_compile_definitions(${target} PRIVATE ${ARG_DEFINITIONS})
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(lodestone::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} ${scope} cxx_std_20)
  foreach(room IN LISTS ARG_DEPENDS)
    target_link_libraries(${target} ${scope} lodestone_${room})
  endforeach()
  foreach(header IN LISTS headers)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestone/${name})
  endforeach()
  install(TARGETS ${target} EXPORT lodestone-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set_property(GLOBAL APPEND PROPERTY LODESTONE_ROOMS ${name})
endfunction()

# lodestone_tests(room [LIBRARIES target...] [ALONE file...] [THREADS]): executable <room>_tests from
# tests/<room>/*_test.cpp, label "unit", or with THREADS "unit-threads": the thread sanitizer looks at those, too. ALONE: as above.
function(lodestone_tests room)
  cmake_parse_arguments(ARG "THREADS" "" "LIBRARIES;ALONE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${room}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${room}_tests ${sources})
  target_link_libraries(${room}_tests PRIVATE lodestone_options lodestone_${room} lodestone_test_support GTest::gtest
                        ${ARG_LIBRARIES})
  list(TRANSFORM ARG_ALONE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${room}/)
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_dependencies(unit_tests ${room}_tests)
  set(label unit)
  if(ARG_THREADS)
    set(label unit-threads)  # ctest -L looks for a part of it
    add_dependencies(thread_tests ${room}_tests)
  endif()
  gtest_discover_tests(${room}_tests TEST_PREFIX "${room}." PROPERTIES LABELS ${label} DISCOVERY_TIMEOUT 60)
endfunction()
