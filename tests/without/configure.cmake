# cmake -DSOURCE=<vantage> -DFOLDER=<folder> -DGENERATOR=<generator> -DCXX=<compiler> -P configure.cmake
# Configures vantage with what a report, the editor or later parts take hidden or switched off, and looks at what would be compiled.
file(REMOVE_RECURSE ${FOLDER})
function(configure name says report edit)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER}/${name} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
                          -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DVANTAGE_BUILD_TESTS=ON ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                          ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${name} does not configure: ${output}${errors}")
  endif()
  if(NOT output MATCHES "${says}")
    message(FATAL_ERROR "${name}: nothing says \"${says}\": ${output}")
  endif()
  file(READ ${FOLDER}/${name}/compile_commands.json commands)
  foreach(source ${report} ${edit})
    if(NOT commands MATCHES "src/${source}")
      message(FATAL_ERROR "${name} does not compile ${source}")
    endif()
  endforeach()
endfunction()
configure(no_meshoptimizer "No report: .*libmeshoptimizer-dev" report/write_report_none.cpp cli/edit_none.cpp -DCMAKE_DISABLE_FIND_PACKAGE_meshoptimizer=ON)
configure(no_three "No report: libjs-three" report/write_report_none.cpp cli/edit_none.cpp -DVANTAGE_THREE_JS=OFF)
configure(no_report "No report: VANTAGE_WITH_REPORT is off" report/write_report_none.cpp cli/edit_none.cpp -DVANTAGE_WITH_REPORT=OFF)
configure(no_editor "No editor: VANTAGE_WITH_EDITOR is off" report/write_report.cpp cli/edit_none.cpp -DVANTAGE_WITH_EDITOR=OFF)
# Parts of the library, without what later parts take.
file(WRITE ${FOLDER}/pkg-config "#!/bin/sh\nfor word; do case $word in cbc|cairo|proj*|minizip) exit 1 ;; esac; done\nexec pkg-config \"$@\"\n")
file(CHMOD ${FOLDER}/pkg-config PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
configure(up_to_scan "No report: the library is built up to its part scan" site/site.cpp evaluate/evaluator.cpp -DVANTAGE_UP_TO=scan
          -DVANTAGE_BUILD_TESTS=OFF -DPKG_CONFIG_EXECUTABLE=${FOLDER}/pkg-config)
file(READ ${FOLDER}/up_to_scan/compile_commands.json commands)
if(commands MATCHES "src/(optimise|cover|plan|taken|export|report|cli)/")
  message(FATAL_ERROR "up to scan, ${CMAKE_MATCH_0} is compiled")
endif()
