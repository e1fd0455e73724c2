# Fails where PROGRAM loads a library of OpenGL or VTK's rendering, by way of others too.
execute_process(COMMAND ldd ${PROGRAM} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
if(NOT libraries MATCHES "libvtkIOCore")
  message(FATAL_ERROR "${PROGRAM} loads no VTK:\n${libraries}")
endif()
string(REGEX MATCHALL "lib(GL|EGL|OpenGL|GLEW|vtkRendering)[^ ]*" drawing "${libraries}")
if(drawing)
  message(FATAL_ERROR "${PROGRAM} loads ${drawing}")
endif()
