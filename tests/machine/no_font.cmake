# cmake -DPROGRAM=<vantage> -DSCENE=<scene> -DFOLDER=<folder> -P no_font.cmake
# Pictures on a machine without a single font: cairo has letters of its own, and what is laid out around them is measured.
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/none)
file(WRITE ${FOLDER}/fonts.conf "<?xml version=\"1.0\"?>\n<!DOCTYPE fontconfig SYSTEM \"fonts.dtd\">\n<fontconfig><dir>${FOLDER}/none</dir></fontconfig>\n")
file(WRITE ${FOLDER}/stations.csv "x,y,z\n0,-8,1.5\n")
foreach(type svg png)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env FONTCONFIG_FILE=${FOLDER}/fonts.conf ${PROGRAM} evaluate ${SCENE} --engine embree --stations ${FOLDER}/stations.csv
                          --step 3 --user-size 0.5 --spacing 0.3 --picture ${FOLDER}/picture.${type} RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "no ${type} without fonts (${status}): ${errors}")
  endif()
endforeach()
# cairo writes a letter as <use xlink:href="#glyph-…">.
file(READ ${FOLDER}/picture.svg svg)
string(REGEX MATCHALL "href=\"#glyph" letters "${svg}")
list(LENGTH letters count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} letters in ${FOLDER}/picture.svg")
endif()
