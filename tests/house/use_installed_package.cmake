# Installs the built package below WORK_DIR, then configures, builds and runs
# tests/outside_project against it with nothing else of ours in sight.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix --config ${CONFIG})

# Headers lie at the top of their modules, sub-folders are internal.
file(GLOB internal ${WORK_DIR}/prefix/include/sightline/*/*/*)
if(internal)
  message(FATAL_ERROR "internal headers were installed: ${internal}")
endif()

set(with_viewers OFF)
if(EXISTS ${WORK_DIR}/prefix/bin/sightline)
  set(with_viewers ON)
  run(${WORK_DIR}/prefix/bin/sightline --version)
endif()

set(flags "")
if(SANITIZE)
  set(flags -D CMAKE_C_FLAGS=-fsanitize=${SANITIZE} -D CMAKE_CXX_FLAGS=-fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} -S ${PROJECT_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=${CONFIG}
    -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D WITH_VIEWERS=${with_viewers} ${flags})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --config ${CONFIG})
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR}/build --output-on-failure -C ${CONFIG})
