# Interface target with the flags our own code (library, program, tests, bench) is compiled with.
add_library(moclean_flags INTERFACE)
target_compile_options(moclean_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(MOCLEAN_WARNINGS_AS_ERRORS)
  target_compile_options(moclean_flags INTERFACE -Werror)
endif()
if(MOCLEAN_SANITIZE)
  target_compile_options(moclean_flags INTERFACE -fsanitize=${MOCLEAN_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all
                         -Wno-maybe-uninitialized)  # GCC 12: false alarms in <regex>
  target_link_options(moclean_flags INTERFACE -fsanitize=${MOCLEAN_SANITIZE})
endif()
