# cmake -D BUILD=... -D GENERATOR=... -D COMPILER=... -D WORK=... -P run.cmake
# Installs the project built in BUILD to WORK/prefix, then configures, builds and runs the project
# beside this file against it.
file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/build ${WORK}/takes)

function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
endfunction()

step("installing" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step("the headers installed" ${CMAKE_CURRENT_LIST_DIR}/../structure/installed_headers.sh ${WORK}/prefix/include)
step("configuring the consumer" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/project -B ${WORK}/build
     -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${COMPILER}
     -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${WORK}/prefix)
step("building the consumer" ${CMAKE_COMMAND} --build ${WORK}/build)
step("running the consumer" ${WORK}/build/consumer ${WORK}/takes)
