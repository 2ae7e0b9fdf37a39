# Compile flags of every target, in one interface library that is never exported.
add_library(vantage_flags INTERFACE)
target_compile_options(
  vantage_flags
  INTERFACE -Wall -Wextra -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
            # Shader and host must round alike: a contracted multiply-add would move a point across a voxel face.
            -ffp-contract=off
            # GCC 12 sees overlapping copies in "literal" + std::string (its bug 105651).
            $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
            # Of several sources at a time, what is unnamed in one is no longer a file's own.
            $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-shadow>
            $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>
            $<$<BOOL:${VANTAGE_WARNINGS_AS_ERRORS}>:-Werror>)
if(VANTAGE_SANITIZE)
  target_compile_options(
    vantage_flags
    INTERFACE -fsanitize=${VANTAGE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined
              # Of a program of tests, what it does to memory counts: the rest would take as long again to compile.
              $<$<BOOL:$<TARGET_PROPERTY:VANTAGE_TEST_PROGRAM>>:-fno-sanitize=undefined>)
  target_link_options(vantage_flags INTERFACE -fsanitize=${VANTAGE_SANITIZE})
endif()
if(VANTAGE_COVERAGE)
  # Counts of several threads are added one by one, or some are lost.
  target_compile_options(vantage_flags INTERFACE --coverage -Og -fprofile-update=atomic)
  target_link_options(vantage_flags INTERFACE --coverage)
endif()
