# Precompiled headers halve the parsing of a build. They hold headers of other projects only, and only
# those that nearly every source of the target includes anyway: a header of ours that lacks an include
# is found by the test `headers`, and a source that lacks one by a build with
# MOCLEAN_PRECOMPILED_HEADERS=OFF.
option(MOCLEAN_PRECOMPILED_HEADERS "Compile the headers of Eigen, fmt and GoogleTest once" ${PROJECT_IS_TOP_LEVEL})

# moclean_precompile(TARGET HEADER...): HEADER, written <Eigen/Core>, is compiled once for TARGET.
function(moclean_precompile target)
  if(MOCLEAN_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# moclean_precompile_as(TARGET OTHER): the same headers for TARGET, which is compiled with the same flags.
function(moclean_precompile_as target other)
  if(MOCLEAN_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()
