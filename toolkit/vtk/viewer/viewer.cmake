# Sets `viewer_source` to the source of the report's 3D viewer: bundled from npm's packages where npm
# is installed and they can be had, otherwise the one that holds none.

option(MIMETRA_REPORT_VIEWER "Give reports a 3D viewer, made of npm packages, where npm is there" ON)

set(viewer_source ${CMAKE_CURRENT_LIST_DIR}/no_viewer_script.cpp)
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
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
                                       ${CMAKE_CURRENT_LIST_DIR}/package-lock.json)
file(SHA256 ${CMAKE_CURRENT_LIST_DIR}/package-lock.json lock)
if(NOT EXISTS ${packages}/${lock}.installed)
  file(REMOVE_RECURSE ${packages})
  file(COPY ${CMAKE_CURRENT_LIST_DIR}/package.json ${CMAKE_CURRENT_LIST_DIR}/package-lock.json
       DESTINATION ${packages})
  message(STATUS "Getting the packages of the report's 3D viewer")
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --fetch-retries=1
            --fetch-timeout=20000
    WORKING_DIRECTORY ${packages}
    RESULT_VARIABLE failed
    OUTPUT_QUIET ERROR_VARIABLE message
    TIMEOUT 300)
  if(failed)
    message(STATUS "npm cannot get them: reports will have no 3D viewer\n${message}")
    return()
  endif()
  file(TOUCH ${packages}/${lock}.installed)
endif()

set(viewer_source ${packages}/viewer_script.cpp)
add_custom_command(
  OUTPUT ${viewer_source}
  COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/bundle.mjs ${packages} ${viewer_source}
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/bundle.mjs ${CMAKE_CURRENT_LIST_DIR}/viewer.js
          ${CMAKE_CURRENT_LIST_DIR}/surface.js ${CMAKE_CURRENT_LIST_DIR}/performance.js
          ${packages}/${lock}.installed
  COMMENT "Bundling the report's 3D viewer"
  VERBATIM)
