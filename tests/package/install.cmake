# Installs BUILD, moves the installation to PREFIX, and checks that it knows no place of this machine
# that a user does not have.
set(before_move ${PREFIX}.before_move)
file(REMOVE_RECURSE ${PREFIX} ${before_move})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${before_move}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${before_move} ${PREFIX})

file(GLOB files ${PREFIX}/${LIBRARIES}/cmake/mimetra/*.cmake)
if(NOT files)
  message(FATAL_ERROR "no CMake package in ${PREFIX}/${LIBRARIES}/cmake/mimetra")
endif()
foreach(file IN LISTS files)
  file(READ ${file} text)
  foreach(place ${BUILD} ${SOURCE} ${before_move} mimetra_flags)
    string(FIND "${text}" ${place} found)
    if(NOT found EQUAL -1)
      message(FATAL_ERROR "${file} holds ${place}")
    endif()
  endforeach()
endforeach()

foreach(document LICENSE README.md CHANGELOG.md)
  if(NOT EXISTS ${PREFIX}/${DOCUMENTS}/${document})
    message(FATAL_ERROR "${document} was not installed")
  endif()
endforeach()
