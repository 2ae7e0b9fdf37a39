# Importers: programs of their own, which nothing links.
add_library(vantage_importer STATIC ${CMAKE_CURRENT_LIST_DIR}/program.cpp ${CMAKE_CURRENT_LIST_DIR}/glb_bytes.cpp)
# Without the sanitizers of vantage_flags: their shadow does not fit into the memory that an importer gets.
target_compile_options(vantage_importer PUBLIC -Wall -Wextra -Wshadow -Wold-style-cast $<$<BOOL:${VANTAGE_WARNINGS_AS_ERRORS}>:-Werror>)
target_compile_features(vantage_importer PUBLIC cxx_std_20)
target_include_directories(vantage_importer PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(vantage_importer PUBLIC nlohmann_json::nlohmann_json)
# vantage_importer(<name> <sources...>), of which the global property VANTAGE_IMPORTERS then has one more.
function(vantage_importer name)
  add_executable(${name} ${ARGN})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_link_libraries(${name} PRIVATE vantage_importer)
  set_property(GLOBAL APPEND PROPERTY VANTAGE_IMPORTERS ${name})
endfunction()
