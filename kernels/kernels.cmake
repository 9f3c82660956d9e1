# moclean_embed_kernels(TARGET): every file below this folder that has kernels, FOLDER/NAME.cl, and the prelude
# become generated sources of TARGET that define moclean::kernel_source::NAME; a generated header,
# moclean/device/kernel_source.hpp, declares them. Files without kernels are there to be included.
function(moclean_embed_kernels target)
  set(folder ${PROJECT_SOURCE_DIR}/kernels)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*.cl)
  set(included)
  set(embedded ${folder}/prelude.cl)
  foreach(file ${files})
    file(STRINGS ${file} kernels REGEX "^kernel " LIMIT_COUNT 1)
    if(kernels)
      list(APPEND embedded ${file})
    else()
      list(APPEND included ${file})
    endif()
  endforeach()

  set(declarations)
  foreach(source ${embedded})
    get_filename_component(name ${source} NAME_WE)
    string(APPEND declarations "extern const std::string_view ${name};\n")
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/kernels/${name}.cl.cpp)
    add_custom_command(
      OUTPUT ${generated}
      COMMAND ${CMAKE_COMMAND} -D NAME=${name} -D SOURCE=${source} -D FOLDER=${folder} -D OUTPUT=${generated}
              -P ${folder}/embed.cmake
      DEPENDS ${source} ${included} ${folder}/embed.cmake
      COMMENT "Embedding ${name}.cl"
      VERBATIM)
    set_source_files_properties(${generated} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    target_sources(${target} PRIVATE ${generated})
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/include/moclean/device/kernel_source.hpp @ONLY CONTENT
       "#pragma once

#include <string_view>

/// The files of kernels/ that have kernels, embedded by the build; each begins with a #line directive.
namespace moclean::kernel_source {

@declarations@
}  // namespace moclean::kernel_source
")
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/include>)
endfunction()
