# Fails where one of LIBRARIES (separated by |) multiplies matrices in blocks, for which Eigen looks
# up its sizes of caches, and never calls fix_product_blocking().
string(REPLACE "|" ";" libraries "${LIBRARIES}")
set(multiplying "")
foreach(library IN LISTS libraries)
  execute_process(COMMAND ${NM} ${library} OUTPUT_VARIABLE symbols ERROR_QUIET
                  COMMAND_ERROR_IS_FATAL ANY)
  if(NOT symbols MATCHES "manage_caching_sizes")
    continue()
  endif()
  list(APPEND multiplying ${library})
  if(NOT symbols MATCHES "fix_product_blocking")
    message(FATAL_ERROR "${library}: multiplies matrices without fix_product_blocking()")
  endif()
endforeach()
if(NOT multiplying)
  message(FATAL_ERROR "no library multiplies matrices: is this still Eigen's name?")
endif()
message(STATUS "${multiplying}")
