# A sanitizer's build, and in `.ci/run` that of `dev`, compile the sources of a folder as one, in half the time.
# `scripts/test dev` compiles each by itself, so that a missing include shows there.
option(MOCLEAN_UNITY "Compile the sources of each folder as one" OFF)
option(MOCLEAN_UNITY_TESTS "Compile several tests of a program as one source" OFF)

# moclean_unity(TARGET [EXCEPT FILE...]): FILE, relative to the current folder, is compiled by itself: its
# unnamed namespace shares names with a neighbour's, or it is as long as all others together.
function(moclean_unity target)
  if(NOT MOCLEAN_UNITY)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" EXCEPT)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(path ${source} ABSOLUTE)
    file(RELATIVE_PATH name ${CMAKE_CURRENT_SOURCE_DIR} ${path})
    get_filename_component(folder /${name} DIRECTORY)
    if(NOT name IN_LIST arg_EXCEPT AND NOT name MATCHES "^\\.\\.")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP folder${folder})
    endif()
  endforeach()
endfunction()
