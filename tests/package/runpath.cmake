# Fails where FILE has an empty entry in its RUNPATH: whoever puts a library into the folder that a
# program is started in would have it loaded.
execute_process(COMMAND ${READELF} --dynamic ${FILE} OUTPUT_VARIABLE dynamic
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT dynamic MATCHES "NEEDED")
  message(FATAL_ERROR "${FILE}: ${READELF} names no library that it needs")
endif()
string(REGEX MATCHALL "R(UN)?PATH[^\n]*" entries "${dynamic}")
if(entries MATCHES "\\[:|::|:\\]|\\[\\]")
  message(FATAL_ERROR "${FILE}: an empty entry in ${entries}")
endif()
message(STATUS "${FILE}: ${entries}")
