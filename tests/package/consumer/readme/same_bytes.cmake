# Runs PROGRAM and COMMAND on twelve frames of the built-in head, and compares what they write.
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})

function(run)
  execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE output
                  COMMAND_ERROR_IS_FATAL ANY)
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${COMMAND} sample -o actor/)
run(${COMMAND} convert actor@identity001=1 --weights actor/performance.csv --frames 0:120:10
    --format obj -o takes/)
file(GLOB frames RELATIVE ${FOLDER}/takes ${FOLDER}/takes/frame_*)
foreach(frame IN LISTS frames)
  string(REPLACE frame_ smile_ name ${frame})
  file(RENAME ${FOLDER}/takes/${frame} ${FOLDER}/takes/${name})
endforeach()

run(${PROGRAM})
if(NOT output MATCHES " over all triangles")
  message(FATAL_ERROR "the program printed: ${output}")
endif()
run(${COMMAND} transfer takes/smile_%04d.obj actor/ -o by_command/)

file(GLOB names RELATIVE ${FOLDER}/by_command ${FOLDER}/by_command/*)
file(GLOB program_names RELATIVE ${FOLDER}/actor_smile ${FOLDER}/actor_smile/*)
list(LENGTH names count)
if(NOT names STREQUAL program_names OR count LESS 12)
  message(FATAL_ERROR "the command wrote ${names}\nand the program ${program_names}")
endif()
# Who wrote the frames, and when, is not the same.
list(REMOVE_ITEM names mimetra-run.json)
foreach(name IN LISTS names)
  run(${CMAKE_COMMAND} -E compare_files actor_smile/${name} by_command/${name})
endforeach()
