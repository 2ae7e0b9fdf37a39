# cmake -DINPUT=<text file> -DOUTPUT=<.cpp> -DSYMBOL=<name> -P embed_text.cmake: the file as `extern const char* const vantage::<name>`.
# With -DPAGE=ON as `extern const PageText vantage::<name>` (src/report/page_files.hpp), its SHA-256 beside it.
file(READ ${INPUT} text)
set(header "// From ${SYMBOL}'s file by cmake/embed_text.cmake.\n")
if(PAGE)
  string(SHA256 hash "${text}")
  file(WRITE ${OUTPUT} "${header}#include \"report/page_files.hpp\"\nnamespace vantage {\nextern const PageText ${SYMBOL};\nconst PageText ${SYMBOL}{R\"text(${text})text\", \"${hash}\"};\n}\n")
else()
  file(WRITE ${OUTPUT} "${header}namespace vantage {\nextern const char* const ${SYMBOL};\nconst char* const ${SYMBOL} = R\"text(${text})text\";\n}\n")
endif()
