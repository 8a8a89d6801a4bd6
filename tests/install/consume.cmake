# cmake -D BUILD_DIR=... -D CONSUMER_DIR=... -D WORK_DIR=... -P consume.cmake
# From an empty prefix each time: an old header left there would hide a missing one.
file(REMOVE_RECURSE ${WORK_DIR})
set(quiet OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --component proc --prefix ${WORK_DIR}/prefix
    ${quiet})
execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
        -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix
    ${quiet})
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK_DIR}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK_DIR}/build/consumer COMMAND_ERROR_IS_FATAL ANY)
