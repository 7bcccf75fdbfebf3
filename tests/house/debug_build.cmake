# Configures, builds and tests the project below WORK_DIR without optimisation (-O0).

include(ProcessorCount)
ProcessorCount(processors)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Debug
    -D CMAKE_CXX_FLAGS_DEBUG=-O0 -D CMAKE_CXX_COMPILER=${COMPILER} -D SIGHTLINE_TESTS=ON)
run(${CMAKE_COMMAND} --build ${WORK_DIR} --parallel ${processors})
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR} --output-on-failure --parallel ${processors}
    --label-exclude slow)
