# cmake -D NAME=gram -D SOURCE=gram.cl -D OUTPUT=gram.cl.cpp -P embed.cmake
# Writes a .cpp that holds the kernel file as one string; #line keeps file and line in compiler logs.
# A line `#include "tiles.cl"` is replaced by that file.
file(READ ${SOURCE} text)
get_filename_component(file ${SOURCE} NAME)
get_filename_component(folder ${SOURCE} DIRECTORY)
string(REGEX MATCHALL "#include \"[a-z_]+\\.cl\"" includes "${text}")
foreach(include IN LISTS includes)
  string(REGEX MATCH "[a-z_]+\\.cl" included "${include}")
  file(READ ${folder}/${included} body)
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
