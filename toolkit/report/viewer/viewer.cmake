# Sets `viewer_source` to the source of the report's 3D viewer: bundled from npm's packages, when it
# is built, where npm is installed and they can be had; otherwise the one that holds none.

option(MIMETRA_REPORT_VIEWER "Give reports a 3D viewer, made of npm packages, where npm is there" ON)

set(without_viewer ${CMAKE_CURRENT_LIST_DIR}/no_viewer_script.cpp)
set(viewer_source ${without_viewer})
if(NOT MIMETRA_REPORT_VIEWER)
  return()
endif()

find_program(NODE node)
find_program(NPM npm)
if(NOT NODE OR NOT NPM)
  message(STATUS "npm was not found: reports will have no 3D viewer")
  return()
endif()

# Packages are kept beside the build, where they stay as long as the lock file does.
set(packages ${CMAKE_CURRENT_BINARY_DIR}/viewer)
set(viewer_source ${CMAKE_CURRENT_BINARY_DIR}/viewer_script.cpp)
set(folder ${CMAKE_CURRENT_LIST_DIR})
# Where the packages could not be had, the next configuration lets it be tried again.
file(GLOB installed ${packages}/*.installed)
if(NOT installed)
  file(REMOVE ${viewer_source})
endif()
add_custom_command(
  OUTPUT ${viewer_source}
  COMMAND ${CMAKE_COMMAND} -DNPM=${NPM} -DNODE=${NODE} -DFOLDER=${folder} -DPACKAGES=${packages}
          -DSOURCE=${viewer_source} -P ${folder}/make_viewer.cmake
  DEPENDS ${folder}/make_viewer.cmake ${folder}/package.json ${folder}/package-lock.json
          ${folder}/bundle.mjs ${folder}/viewer.js ${folder}/surface.js ${folder}/performance.js
          ${without_viewer}
  COMMENT "Making the report's 3D viewer"
  VERBATIM)
# One literal of half a megabyte, which compilers hold and the standard need not.
set_source_files_properties(${viewer_source} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
