# One library per folder; `#include <mimetra/FOLDER/header.h>` means the same in the source tree and
# in an installation.

set(MIMETRA_INCLUDE_ROOT ${PROJECT_BINARY_DIR}/include)

# mimetra_library(NAME SOURCES ... [USES libraries seen in headers] [PRIVATE libraries of .cpp files])
function(mimetra_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PRIVATE" ${ARGN})
  add_library(mimetra_${name} STATIC ${ARG_SOURCES})
  add_library(mimetra::${name} ALIAS mimetra_${name})
  set_target_properties(mimetra_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mimetra_${name} PUBLIC $<BUILD_INTERFACE:${MIMETRA_INCLUDE_ROOT}>
                                                    $<INSTALL_INTERFACE:include>)
  target_link_libraries(mimetra_${name} PUBLIC ${ARG_USES} PRIVATE ${ARG_PRIVATE} mimetra_flags)
  file(MAKE_DIRECTORY ${MIMETRA_INCLUDE_ROOT}/mimetra)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${MIMETRA_INCLUDE_ROOT}/mimetra/${name} SYMBOLIC)
endfunction()

# mimetra_test(NAME SOURCES ... USES ...): one GoogleTest program, one ctest entry per test.
function(mimetra_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_include_directories(${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name}_test PRIVATE ${ARG_USES} mimetra_flags mimetra_test_folders
                                             GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name}_test NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
