# moclean_embed_kernels(TARGET STEM...): every kernels/STEM.cl becomes one generated .cpp of TARGET that
# defines moclean::kernel_source::STEM (declared in host/moclean/device/kernel_source.hpp).
set(moclean_included_kernels conjugate_sums entry householder load_rows norms_entry ql search_entry
    state temporal_entry tiles)
list(TRANSFORM moclean_included_kernels REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/kernels/\\1.cl")
function(moclean_embed_kernels target)
  foreach(kernel ${ARGN})
    set(source ${PROJECT_SOURCE_DIR}/kernels/${kernel}.cl)
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/kernels/${kernel}.cl.cpp)
    add_custom_command(
      OUTPUT ${generated}
      COMMAND ${CMAKE_COMMAND} -D NAME=${kernel} -D SOURCE=${source} -D OUTPUT=${generated}
              -P ${PROJECT_SOURCE_DIR}/kernels/embed.cmake
      DEPENDS ${source} ${moclean_included_kernels} ${PROJECT_SOURCE_DIR}/kernels/embed.cmake
      COMMENT "Embedding ${kernel}.cl"
      VERBATIM)
    set_source_files_properties(${generated} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    target_sources(${target} PRIVATE ${generated})
  endforeach()
endfunction()
