# cmake -DINPUT=<text file> -DOUTPUT=<.cpp> -DSYMBOL=<name> -P embed_text.cmake: the file as `extern const char* const vantage::<name>`.
file(READ ${INPUT} text)
file(WRITE ${OUTPUT} "// From ${SYMBOL}'s file by cmake/embed_text.cmake.\nnamespace vantage {\nextern const char* const ${SYMBOL};\nconst char* const ${SYMBOL} = R\"text(${text})text\";\n}\n")
