# Gets the packages of FOLDER's lock file by NPM into PACKAGES, unless they are there, and bundles
# them with the viewer by NODE as SOURCE. Where they cannot be had, SOURCE holds no viewer.
file(SHA256 ${FOLDER}/package-lock.json lock)
if(NOT EXISTS ${PACKAGES}/${lock}.installed)
  file(REMOVE_RECURSE ${PACKAGES})
  file(COPY ${FOLDER}/package.json ${FOLDER}/package-lock.json DESTINATION ${PACKAGES})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --fetch-retries=1
            --fetch-timeout=20000
    WORKING_DIRECTORY ${PACKAGES}
    RESULT_VARIABLE failed
    OUTPUT_QUIET ERROR_VARIABLE reason
    TIMEOUT 300)
  if(failed)
    message("npm cannot get the packages of the report's 3D viewer: reports will have none until it "
            "can and mimetra is configured and built again\n${reason}")
    configure_file(${FOLDER}/no_viewer_script.cpp ${SOURCE} COPYONLY)
    file(TOUCH_NOCREATE ${SOURCE})
    return()
  endif()
  file(TOUCH ${PACKAGES}/${lock}.installed)
endif()
execute_process(COMMAND ${NODE} ${FOLDER}/bundle.mjs ${PACKAGES} ${SOURCE}
                COMMAND_ERROR_IS_FATAL ANY)
