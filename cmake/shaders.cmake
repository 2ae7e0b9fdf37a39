# vantage_shader(<target> <symbol> <source> [DEFINES ...]): compiles a compute shader to SPIR-V at build time and embeds it as
# `extern const std::uint32_t <symbol>[]` with `<symbol>_size` (in bytes); declared in the generated embedded_shaders.hpp.
set(VANTAGE_SHADER_DIR ${PROJECT_BINARY_DIR}/shaders)
file(MAKE_DIRECTORY ${VANTAGE_SHADER_DIR})

function(vantage_shader target symbol source)
  cmake_parse_arguments(ARG "" "" "DEFINES" ${ARGN})
  set(header ${VANTAGE_SHADER_DIR}/${symbol}.h)
  set(unit ${VANTAGE_SHADER_DIR}/${symbol}.cpp)
  list(TRANSFORM ARG_DEFINES PREPEND -D)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${VANTAGE_GLSLANG} -V --quiet --target-env vulkan1.2 -S comp -I${PROJECT_SOURCE_DIR}/shaders ${ARG_DEFINES}
            --depfile ${header}.d --vn ${symbol}_words -o ${header} ${PROJECT_SOURCE_DIR}/shaders/${source}
    DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${source}
    DEPFILE ${header}.d
    VERBATIM
    COMMENT "Compiling shader ${symbol}")
  file(CONFIGURE OUTPUT ${unit} @ONLY
       CONTENT "#include <cstddef>\n#include <cstdint>\n#include \"@symbol@.h\"\nnamespace vantage::shaders {\nextern const std::uint32_t* const @symbol@ = @symbol@_words;\nextern const std::size_t @symbol@_size = sizeof @symbol@_words;\n}\n")
  set_property(SOURCE ${unit} APPEND PROPERTY OBJECT_DEPENDS ${header})
  target_sources(${target} PRIVATE ${unit})
  target_include_directories(${target} PRIVATE ${VANTAGE_SHADER_DIR})
  set_property(TARGET ${target} APPEND_STRING PROPERTY VANTAGE_SHADER_DECLARATIONS
               "extern const std::uint32_t* const ${symbol};\nextern const std::size_t ${symbol}_size;\n")
  get_target_property(declarations ${target} VANTAGE_SHADER_DECLARATIONS)
  file(CONFIGURE OUTPUT ${VANTAGE_SHADER_DIR}/embedded_shaders.hpp
       CONTENT "#pragma once\n#include <cstddef>\n#include <cstdint>\nnamespace vantage::shaders {\n${declarations}}\n")
endfunction()
