# cmake -D NAME=gram -D SOURCE=.../kernels/linalg/gram.cl -D FOLDER=.../kernels -D OUTPUT=gram.cl.cpp -P embed.cmake
# Writes a .cpp that holds the kernel file as one string; #line keeps file and line in compiler logs.
# A line `#include "linalg/tiles.cl"` is replaced by that file of FOLDER.
file(READ ${SOURCE} text)
file(RELATIVE_PATH file ${FOLDER} ${SOURCE})
string(REGEX MATCHALL "#include \"[a-z_/]+\\.cl\"" includes "${text}")
foreach(include IN LISTS includes)
  string(REGEX MATCH "[a-z_/]+\\.cl" included "${include}")
  file(READ ${FOLDER}/${included} body)
  string(FIND "${text}" "${include}" at)
  string(SUBSTRING "${text}" 0 ${at} before)
  string(REGEX MATCHALL "\n" lines "${before}")
  list(LENGTH lines line)
  math(EXPR line "${line} + 2")
  string(REPLACE "${include}\n" "#line 1 \"${included}\"\n${body}#line ${line} \"${file}\"\n" text
         "${text}")
endforeach()
file(WRITE ${OUTPUT} "#include \"moclean/device/kernel_source.hpp\"

const std::string_view moclean::kernel_source::${NAME} =
    R\"kernel(#line 1 \"${file}\"
${text})kernel\";
")
