# gonio_library(NAME SOURCES ... [PUBLIC libs] [PRIVATE libs]): the one target of a folder.
# gonio_test(NAME LABEL label SOURCES ... LIBS ... [TIMEOUT seconds] [WRAPPER command ...]): a
# GoogleTest program with one label. A label `run` takes all cores: its tests run alone.
# gonio_program_test(...): likewise, for tests that run the built programs; uses_programs(NAME) tells a
# test where they are (GONIO_PROGRAM, GONIO_DAEMON).

add_library(gonio_options INTERFACE)
target_compile_options(gonio_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
    -Wno-missing-field-initializers  # a designated initialiser leaves the rest at its default
    $<$<BOOL:${GONIO_WERROR}>:-Werror>)
if(GONIO_SANITIZE)
    target_compile_options(gonio_options INTERFACE
        -fsanitize=${GONIO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(gonio_options INTERFACE -fsanitize=${GONIO_SANITIZE})
endif()

set_property(GLOBAL PROPERTY GONIO_PROC_TARGETS "")

function(gonio_library name)
    cmake_parse_arguments(LIB "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    set(target gonio_${name})
    add_library(${target} STATIC ${LIB_SOURCES})
    add_library(gonio::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${target} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include/gonio>)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_link_libraries(${target} PUBLIC ${LIB_PUBLIC}
        PRIVATE ${LIB_PRIVATE} $<BUILD_INTERFACE:gonio_options>)
    file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    if(folder MATCHES "^proc/")
        target_compile_options(${target} PRIVATE -ffp-contract=off)
        set_property(GLOBAL APPEND PROPERTY GONIO_PROC_TARGETS ${target})
    endif()
endfunction()

function(gonio_test name)
    cmake_parse_arguments(TEST "" "LABEL;TIMEOUT" "SOURCES;LIBS;WRAPPER" ${ARGN})
    if(NOT TEST_TIMEOUT)
        set(TEST_TIMEOUT 120)
    endif()
    set(alone FALSE)
    if(TEST_LABEL STREQUAL run)
        set(alone TRUE)
    endif()
    add_executable(${name} ${TEST_SOURCES})
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE ${TEST_LIBS} GTest::gtest_main gonio_options)
    target_compile_definitions(${name} PRIVATE
        GONIO_SOURCE_DIR="${CMAKE_SOURCE_DIR}" GONIO_DATA_DIR="${GONIO_DATA_DIR}")
    if(TEST_WRAPPER)
        set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "${TEST_WRAPPER}")
    endif()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
        PROPERTIES LABELS "${TEST_LABEL}" TIMEOUT ${TEST_TIMEOUT} RUN_SERIAL ${alone})
endfunction()

function(uses_programs name)
    target_compile_definitions(${name} PRIVATE
        GONIO_PROGRAM="$<TARGET_FILE:gonio>" GONIO_DAEMON="$<TARGET_FILE:goniod>")
    add_dependencies(${name} gonio goniod)
endfunction()

function(gonio_program_test name)
    gonio_test(${name} ${ARGN})
    uses_programs(${name})
endfunction()
