# cmake -D FILE=record.json -D "KEYS=inputs;0;frames" -P json.cmake
# Prints one value of a JSON file; the key LENGTH, at the end, asks for the size of an array.
file(READ ${FILE} record)
list(GET KEYS -1 last)
if(last STREQUAL LENGTH)
  list(POP_BACK KEYS)
  string(JSON value LENGTH "${record}" ${KEYS})
else()
  string(JSON value GET "${record}" ${KEYS})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E echo "${value}")
