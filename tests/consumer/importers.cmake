# An installed program finds its importers where they were installed with it, and takes an OBJ.
file(REMOVE_RECURSE ${FOLDER})
file(WRITE ${FOLDER}/site.obj "o wall\nv 0 0 0\nv 4 0 0\nv 0 3 0\nf 1 2 3\n")
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=VANTAGE_IMPORTERS XDG_CACHE_HOME=${FOLDER}/cache ${PROGRAM} import site.obj -o site.glb
                WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE text)
if(NOT text MATCHES "1 triangles in 1 meshes")
  message(FATAL_ERROR "the installed program says: ${text}")
endif()
file(READ ${FOLDER}/site.glb magic LIMIT 4 HEX)
if(NOT magic STREQUAL 676c5446)
  message(FATAL_ERROR "site.glb begins with ${magic}")
endif()
