# cmake -DADDON=FOLDER -DMODULE=FOLDER -DLIBRARY=FILE -DLICENSE=FILE -DZIP=FILE -P zip_addon.cmake
get_filename_component(folder ${ZIP} DIRECTORY)
set(staged ${folder}/mimetra_blender)
file(REMOVE_RECURSE ${staged})
file(GLOB sources ${ADDON}/*.py)
file(GLOB modules ${MODULE}/*.py)
list(FILTER modules EXCLUDE REGEX "/stub.py$")
file(COPY ${sources} ${LICENSE} DESTINATION ${staged})
file(COPY ${modules} DESTINATION ${staged}/mimetra)

# Beside each other: the library looks for what it needs in its own folder.
get_filename_component(library ${LIBRARY} REALPATH)
file(COPY_FILE ${library} ${staged}/mimetra/libmimetra_c.so)
file(
  GET_RUNTIME_DEPENDENCIES
  RESOLVED_DEPENDENCIES_VAR needed
  LIBRARIES ${library}
  PRE_INCLUDE_REGEXES "^libOpenMesh" "^libdlib"
  PRE_EXCLUDE_REGEXES ".*")
foreach(each IN LISTS needed)
  get_filename_component(name ${each} NAME)
  get_filename_component(file ${each} REALPATH)
  file(COPY_FILE ${file} ${staged}/mimetra/${name})
  # Its licence asks to go along.
  execute_process(COMMAND dpkg-query -S ${file} OUTPUT_VARIABLE package ERROR_QUIET)
  string(REGEX REPLACE ":.*" "" package "${package}")
  if(package)
    file(COPY_FILE /usr/share/doc/${package}/copyright ${staged}/mimetra/${package}.copyright)
  else()
    message(WARNING "${file} is of no package: its licence is not in the zip")
  endif()
endforeach()

file(REMOVE ${ZIP})
execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ${ZIP} --format=zip mimetra_blender
                WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
