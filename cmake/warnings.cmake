# Interface target with the flags our own code (library, program, tests, bench) is compiled with.
add_library(moclean_flags INTERFACE)
target_compile_options(moclean_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion
                       $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>  # else of a neighbour's names
                       $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)  # as in GCC's -Wconversion
if(MOCLEAN_WARNINGS_AS_ERRORS)
  target_compile_options(moclean_flags INTERFACE -Werror)
endif()
if(MOCLEAN_SANITIZE)
  # Of an access beyond an object or through a null pointer AddressSanitizer tells, too. Without these checks
  # sources that use Eigen compile in 0.6 of the time (docs/decisions/ci-time.md).
  set(MOCLEAN_NO_SANITIZER -fno-sanitize=all)  # where a source only calls Eigen
  target_compile_options(moclean_flags INTERFACE -fsanitize=${MOCLEAN_SANITIZE}
                         -fno-sanitize=null,alignment,pointer-overflow,object-size
                         -fno-omit-frame-pointer -fno-sanitize-recover=all
                         $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # GCC 12: false alarms in <regex>
  target_link_options(moclean_flags INTERFACE -fsanitize=${MOCLEAN_SANITIZE})
endif()

option(MOCLEAN_UNOPTIMISED "Compile the tests, and with sanitizers the program's commands, at -O0" OFF)

# moclean_unoptimised(TARGET SCOPE): the target compiles at -O0, in half the time; with the scope PUBLIC what
# links to it does, too. Only for sources that leave the work to the library. Of an inline function that
# both hold the linker takes what comes first: that has to be the library's, for Eigen crawls at -O0.
function(moclean_unoptimised target scope)
  if(MOCLEAN_UNOPTIMISED)
    target_compile_options(${target} ${scope} -O0)
    target_link_options(${target} INTERFACE
                        LINKER:--whole-archive,$<TARGET_FILE:moclean>,--no-whole-archive)
  endif()
endfunction()
