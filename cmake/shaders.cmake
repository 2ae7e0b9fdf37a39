# vantage_shader(<target> <symbol> <source> [DEFINES ...] [INCLUDES ...]): compiles a compute shader to SPIR-V at build time and
# embeds it as `extern const std::span<const std::uint32_t> <symbol>`, declared in the target's own embedded_shaders.hpp. Paths are
# relative to shaders/, where includes are looked for too. Call it in the folder that makes the target.
function(vantage_shader target symbol source)
  cmake_parse_arguments(ARG "" "" "DEFINES;INCLUDES" ${ARGN})
  set(root ${PROJECT_SOURCE_DIR}/shaders)
  get_filename_component(source ${source} ABSOLUTE BASE_DIR ${root})
  set(options -I${root})
  foreach(folder IN LISTS ARG_INCLUDES)
    get_filename_component(folder ${folder} ABSOLUTE BASE_DIR ${root})
    list(APPEND options -I${folder})
  endforeach()
  list(TRANSFORM ARG_DEFINES PREPEND -D)
  set(folder ${PROJECT_BINARY_DIR}/shaders/${target})
  file(MAKE_DIRECTORY ${folder})
  set(header ${folder}/${symbol}.h)
  set(unit ${folder}/${symbol}.cpp)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${VANTAGE_GLSLANG} -V --quiet --target-env vulkan1.2 -S comp ${options} ${ARG_DEFINES} --depfile ${header}.d
            --vn ${symbol}_words -o ${header} ${source}
    DEPENDS ${source}
    DEPFILE ${header}.d
    VERBATIM
    COMMENT "Compiling shader ${symbol}")
  file(CONFIGURE OUTPUT ${unit} @ONLY
       CONTENT "#include \"embedded_shaders.hpp\"\n#include \"@symbol@.h\"\nnamespace vantage::shaders {\nconstinit const std::span<const std::uint32_t> @symbol@(@symbol@_words);\n}\n")
  set_property(SOURCE ${unit} APPEND PROPERTY OBJECT_DEPENDS ${header})
  target_sources(${target} PRIVATE ${unit})
  target_include_directories(${target} PRIVATE ${folder})
  set_property(TARGET ${target} APPEND_STRING PROPERTY VANTAGE_SHADER_DECLARATIONS
               "extern const std::span<const std::uint32_t> ${symbol};\n")
  get_target_property(declarations ${target} VANTAGE_SHADER_DECLARATIONS)
  file(CONFIGURE OUTPUT ${folder}/embedded_shaders.hpp
       CONTENT "#pragma once\n#include <cstdint>\n#include <span>\nnamespace vantage::shaders {\n${declarations}}\n")
endfunction()

# vantage_engine_shaders(<target> <engine> <folder>): the kernels that trace, with the trace() of <folder>/trace.glsl, as count_<engine>,
# scan_<engine>, sample_probe_<engine> and sample_trace_<engine>.
function(vantage_engine_shaders target engine folder)
  foreach(kernel count scan sample_probe sample_trace)
    vantage_shader(${target} ${kernel}_${engine} ${kernel}.comp INCLUDES ${folder})
  endforeach()
endfunction()
