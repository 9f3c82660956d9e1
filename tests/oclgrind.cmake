# cmake -D OCLGRIND=... -D PROGRAM=... -D FILTER=... -P oclgrind.cmake
# Runs the chosen cases of a test program under Oclgrind, each in a process of its own (Oclgrind 21.10
# takes memory that was released and allocated again for uninitialised). Fails if a case fails or if
# Oclgrind reports anything at all.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_filter=${FILTER}
                OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" listing "${listing}")
set(cases)
foreach(line ${listing})
  if(line MATCHES "^([^ ]+\\.)")
    set(suite ${CMAKE_MATCH_1})
  elseif(line MATCHES "^  ([^ ]+)")
    list(APPEND cases ${suite}${CMAKE_MATCH_1})
  endif()
endforeach()
if(NOT cases)
  message(FATAL_ERROR "no test matches ${FILTER}")
endif()

foreach(case ${cases})
  execute_process(
    COMMAND ${OCLGRIND} --data-races --uninitialized --check-api ${PROGRAM} --gtest_filter=${case}
            --gtest_brief=1
    OUTPUT_VARIABLE output ERROR_VARIABLE findings RESULT_VARIABLE result)
  message(STATUS "${case}")
  if(NOT result EQUAL 0 OR NOT output MATCHES "\\[  PASSED  \\] 1" OR NOT findings STREQUAL "")
    message(FATAL_ERROR "${case} under Oclgrind (result ${result}):\n${output}\n${findings}")
  endif()
endforeach()
