# One library per folder. An include names the header's path from the root of the tree, which an
# installation keeps below include/mimetra; each library is a component of the package.

include(GNUInstallDirs)
get_filename_component(MIMETRA_ROOT ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
if(PROJECT_NAME STREQUAL mimetra)
  include_directories(${MIMETRA_ROOT})
  # What users write, `#include <mimetra/toolkit/mesh/tri_mesh.h>`, holds for samples and consumers
  # of the build tree.
  set(MIMETRA_CONSUMER_INCLUDES ${PROJECT_BINARY_DIR}/as_installed)
  file(MAKE_DIRECTORY ${MIMETRA_CONSUMER_INCLUDES})
  file(CREATE_LINK ${MIMETRA_ROOT} ${MIMETRA_CONSUMER_INCLUDES}/mimetra SYMBOLIC)
else()
  # The headers of the installation come before those of the checkout: what is linked is installed.
  add_compile_options(-idirafter${MIMETRA_ROOT})
endif()
set(MIMETRA_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/mimetra)

# mimetra_component(NAME [USES components] [PACKAGES ...]): installs the target mimetra_NAME as the
# package's component mimetra::NAME.
function(mimetra_component name)
  cmake_parse_arguments(ARG "" "" "USES;PACKAGES" ${ARGN})
  install(TARGETS mimetra_${name} EXPORT mimetra_${name})
  install(EXPORT mimetra_${name} FILE mimetra_${name}.cmake NAMESPACE mimetra::
          DESTINATION ${MIMETRA_PACKAGE_FOLDER})
  set_property(GLOBAL APPEND PROPERTY MIMETRA_COMPONENTS ${name})
  set_property(GLOBAL PROPERTY MIMETRA_${name}_USES ${ARG_USES})
  set_property(GLOBAL PROPERTY MIMETRA_${name}_PACKAGES ${ARG_PACKAGES})
endfunction()

# mimetra_library(NAME
#   SOURCES ...
#   HEADERS those that are installed
#   [USES libraries seen in headers]
#   [PRIVATE libraries of .cpp files]
#   [PACKAGES what users must find to link it, each a mimetra_package()])
function(mimetra_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;USES;PRIVATE;PACKAGES" ${ARGN})
  add_library(mimetra_${name} STATIC ${ARG_SOURCES})
  add_library(mimetra::${name} ALIAS mimetra_${name})
  # Plugins are shared libraries that hold these, and show their hosts nothing of them.
  set_target_properties(
    mimetra_${name}
    PROPERTIES EXPORT_NAME ${name}
               POSITION_INDEPENDENT_CODE ON
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON)
  target_compile_features(mimetra_${name} PUBLIC cxx_std_20)
  # What one library allocates another frees: Eigen must align alike, whatever -march each has. It
  # takes the larger of this and what the instructions like best, which is 64 at most; members of
  # structs stay at 16.
  target_compile_definitions(mimetra_${name} PUBLIC EIGEN_MAX_ALIGN_BYTES=64
                                                    EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_include_directories(
    mimetra_${name} INTERFACE $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/mimetra>)
  if(MIMETRA_CONSUMER_INCLUDES)
    target_include_directories(
      mimetra_${name} INTERFACE $<BUILD_INTERFACE:${MIMETRA_ROOT}>
                                $<BUILD_INTERFACE:${MIMETRA_CONSUMER_INCLUDES}>)
  endif()
  target_link_libraries(
    mimetra_${name}
    PUBLIC ${ARG_USES}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:mimetra_flags>)
  file(RELATIVE_PATH folder ${MIMETRA_ROOT} ${CMAKE_CURRENT_SOURCE_DIR})
  install(FILES ${ARG_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mimetra/${folder})
  set(uses ${ARG_USES})
  list(FILTER uses INCLUDE REGEX "^mimetra::")
  list(TRANSFORM uses REPLACE "^mimetra::" "")
  mimetra_component(${name} USES ${uses} PACKAGES ${ARG_PACKAGES})
endfunction()

# documented_lines(DOCUMENT NUMBER VARIABLE): the C++ lines in a document of the project, those of
# its block of that number, from 1 on; read again where the document changes.
function(documented_lines document number variable)
  set(path ${PROJECT_SOURCE_DIR}/${document})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  file(READ ${path} text)
  set(fence "```cpp\n")
  string(LENGTH "${fence}" length)
  foreach(block RANGE 1 ${number})
    string(FIND "${text}" "${fence}" begin)
    if(begin EQUAL -1)
      message(FATAL_ERROR "${document} has no C++ lines of number ${block}")
    endif()
    math(EXPR begin "${begin} + ${length}")
    string(SUBSTRING "${text}" ${begin} -1 text)
  endforeach()
  string(FIND "${text}" "```" end)
  string(SUBSTRING "${text}" 0 ${end} lines)
  set(${variable} "${lines}" PARENT_SCOPE)
endfunction()

# mimetra_test(NAME SOURCES ... USES ... [PROCESSES ...] [OPTIMIZED]): one GoogleTest program, whose
# tests are dealt out to so many processes, each of which is one of ctest's: with sanitizers a program
# takes longer to start than most tests do.
function(mimetra_test name)
  cmake_parse_arguments(ARG "OPTIMIZED" "PROCESSES" "SOURCES;USES" ${ARGN})
  add_executable(${name}_test ${ARG_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${ARG_USES} mimetra_flags mimetra_test_folders
                                             GTest::gmock GTest::gtest_main)
  # Most tests take longer to compile than to run. The linker takes templates of Eigen from the test's
  # files, though, also for the libraries: tests that compute much are OPTIMIZED.
  if(MIMETRA_SANITIZE AND NOT ARG_OPTIMIZED)
    target_compile_options(${name}_test PRIVATE -O0)
  endif()
  if(NOT ARG_PROCESSES)
    set(ARG_PROCESSES 4)
  endif()
  foreach(process RANGE 1 ${ARG_PROCESSES})
    math(EXPR index "${process} - 1")
    add_test(NAME ${name}.${process}_of_${ARG_PROCESSES} COMMAND ${name}_test --gtest_brief=1)
    set_tests_properties(
      ${name}.${process}_of_${ARG_PROCESSES}
      PROPERTIES ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_PROCESSES};GTEST_SHARD_INDEX=${index}"
                 TIMEOUT 900)
  endforeach()
endfunction()
