# cmake -D NAME=style "-D FILES=a.css;b.css" -D OUTPUT=style.cpp -P embed.cmake
# Writes a .cpp that holds the files, one after the other, as one string. Text that would end the
# element of the page it stands in is refused; the comment that names a source map is left out, because a
# browser would look for the file.
set(text "")
foreach(file IN LISTS FILES)
  file(READ ${file} content)
  if(NOT NAME STREQUAL page)
    string(TOLOWER "${content}" lower)
    foreach(end "</script" "</style" "<!--" "-->" ")asset\"")
      string(FIND "${lower}" "${end}" found)
      if(NOT found EQUAL -1)
        message(FATAL_ERROR "${file} holds ${end}, which may not stand in a report")
      endif()
    endforeach()
  endif()
  string(REGEX REPLACE "/[/*]# sourceMappingURL=[^\n]*" "" content "${content}")
  string(APPEND text "${content}\n")
endforeach()
if(text STREQUAL "")
  set(literal "{}")
else()
  set(literal "= R\"asset(${text})asset\"")
endif()
file(WRITE ${OUTPUT} "#include \"moclean/report/assets.hpp\"

const std::string_view moclean::report_asset::${NAME} ${literal};
")
