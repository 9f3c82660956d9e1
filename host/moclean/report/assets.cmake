# Embeds the page of the report into the library. Included where the target is made: a custom command
# belongs to its folder.

# The libraries of the page come from Debian's libjs-three and libjs-dygraphs. Without them everything
# else is built, and asking for a report is an error that says what to install.
set(javascript /usr/share/javascript)
find_file(MOCLEAN_THREE_JS three.min.js PATHS ${javascript}/three NO_DEFAULT_PATH)
find_file(MOCLEAN_ORBIT_CONTROLS_JS OrbitControls.js PATHS ${javascript}/three/examples/js/controls
          NO_DEFAULT_PATH)
find_file(MOCLEAN_DYGRAPH_JS dygraph.min.js PATHS ${javascript}/dygraphs NO_DEFAULT_PATH)
find_file(MOCLEAN_DYGRAPH_CSS dygraph.min.css PATHS ${javascript}/dygraphs NO_DEFAULT_PATH)
foreach(library MOCLEAN_THREE_JS MOCLEAN_ORBIT_CONTROLS_JS MOCLEAN_DYGRAPH_JS MOCLEAN_DYGRAPH_CSS)
  if(NOT ${library})
    message(WARNING "${library} is not found (libjs-three, libjs-dygraphs): no HTML reports")
  endif()
endforeach()

# moclean_embed_asset(NAME FILE...): moclean::report_asset::NAME is the text of the files, one after
# the other, of those that were found.
function(moclean_embed_asset name)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/report/${name}.cpp)
  set(embed ${CMAKE_CURRENT_SOURCE_DIR}/report/embed.cmake)
  set(files "${ARGN}")
  list(FILTER files EXCLUDE REGEX "^$|NOTFOUND")
  add_custom_command(
    OUTPUT ${generated}
    COMMAND ${CMAKE_COMMAND} -D NAME=${name} "-D FILES=${files}" -D OUTPUT=${generated} -P ${embed}
    DEPENDS ${files} ${embed}
    COMMENT "Embedding ${name} of the report"
    VERBATIM)
  # Clang counts the characters of a string even in C++.
  set_source_files_properties(${generated} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings
                                                      SKIP_PRECOMPILE_HEADERS ON)
  target_sources(moclean PRIVATE ${generated})
endfunction()

set(assets ${CMAKE_CURRENT_SOURCE_DIR}/report/assets)
set(scripts data state theme charts headline view flat_view scene_view player curves heat_map tables
            main)
list(TRANSFORM scripts REPLACE "(.+)" "${assets}/\\1.js")
moclean_embed_asset(page ${assets}/page.html)
moclean_embed_asset(style ${assets}/style.css)
moclean_embed_asset(script ${scripts})
moclean_embed_asset(licenses ${assets}/licenses.txt)
moclean_embed_asset(three ${MOCLEAN_THREE_JS})
moclean_embed_asset(orbit_controls ${MOCLEAN_ORBIT_CONTROLS_JS})
moclean_embed_asset(dygraph ${MOCLEAN_DYGRAPH_JS})
moclean_embed_asset(dygraph_style ${MOCLEAN_DYGRAPH_CSS})
