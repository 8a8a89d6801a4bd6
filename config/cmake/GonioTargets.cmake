# gonio_library(NAME SOURCES ... [PUBLIC libs] [PRIVATE libs]): the one target of a folder.
# gonio_test(NAME LABEL label SOURCES ... LIBS ... [TIMEOUT seconds] [WRAPPER command ...]): a
# GoogleTest program with one label.
# gonio_program_test(...): likewise, for tests that run the built programs and have no work of their own;
# uses_programs(NAME) tells a test where they are (GONIO_PROGRAM, GONIO_DAEMON).

# A test's own loops are short: what they call is optimised.
set(GONIO_TEST_OPTIONS -O1)
set(GONIO_PROGRAM_TEST_OPTIONS -O0)

add_library(gonio_options INTERFACE)
target_compile_options(gonio_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
    -Wno-missing-field-initializers  # a designated initialiser leaves the rest at its default
    -ffp-contract=off  # the same numbers on every machine
    # GCC 12 takes std::string's moves for overruns, and a precompiled header no longer for a system's.
    $<$<AND:$<BOOL:${GONIO_PRECOMPILE}>,$<CXX_COMPILER_ID:GNU>>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread>
    $<$<BOOL:${GONIO_WERROR}>:-Werror>)
if(GONIO_SANITIZE)
    target_compile_options(gonio_options INTERFACE
        -fsanitize=${GONIO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(gonio_options INTERFACE -fsanitize=${GONIO_SANITIZE})
endif()

# More than half of a compilation is reading the standard library, Eigen and GoogleTest: with
# GONIO_PRECOMPILE each is read once. Without it, each file must include all that it needs itself.
set(GONIO_COMMON_HEADERS
    <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <iostream> <limits>
    <map> <memory> <mutex> <optional> <span> <sstream> <string> <string_view> <thread> <utility>
    <vector> <Eigen/Geometry>)

# precompiled_headers(NAME HEADER...): a target whose precompiled headers others of its kind share.
function(precompiled_headers name)
    file(CONFIGURE OUTPUT ${name}.cpp CONTENT "// For the headers.\n")
    add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    target_link_libraries(${name} PRIVATE Eigen3::Eigen gonio_options)
    target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()
if(GONIO_PRECOMPILE)
    precompiled_headers(gonio_library_headers ${GONIO_COMMON_HEADERS})
    set_target_properties(gonio_library_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(GONIO_BUILD_TESTS)
        precompiled_headers(gonio_test_headers ${GONIO_COMMON_HEADERS} <random> <gtest/gtest.h>)
        target_compile_options(gonio_test_headers PRIVATE ${GONIO_TEST_OPTIONS})
        precompiled_headers(gonio_program_test_headers
            ${GONIO_COMMON_HEADERS} <random> <gtest/gtest.h> <nlohmann/json.hpp>)
        target_compile_options(gonio_program_test_headers PRIVATE ${GONIO_PROGRAM_TEST_OPTIONS})
        foreach(headers gonio_test_headers gonio_program_test_headers)
            target_link_libraries(${headers} PRIVATE GTest::gtest nlohmann_json::nlohmann_json)
        endforeach()
    endif()
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
    if(GONIO_PRECOMPILE)
        target_precompile_headers(${target} REUSE_FROM gonio_library_headers)
    endif()
    if(folder MATCHES "^proc/")
        set_property(GLOBAL APPEND PROPERTY GONIO_PROC_TARGETS ${target})
    endif()
endfunction()

function(gonio_test name)
    cmake_parse_arguments(TEST "RUNS_PROGRAMS" "LABEL;TIMEOUT;COST" "SOURCES;LIBS;WRAPPER" ${ARGN})
    if(NOT TEST_TIMEOUT)
        set(TEST_TIMEOUT 120)
    endif()
    if(NOT TEST_COST)
        set(TEST_COST 0)
    endif()
    add_executable(${name} ${TEST_SOURCES})
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE ${TEST_LIBS} GTest::gtest_main gonio_options)
    target_compile_definitions(${name} PRIVATE
        GONIO_SOURCE_DIR="${CMAKE_SOURCE_DIR}" GONIO_DATA_DIR="${GONIO_DATA_DIR}")
    if(TEST_RUNS_PROGRAMS)
        set(options ${GONIO_PROGRAM_TEST_OPTIONS})
        set(headers gonio_program_test_headers)
    else()
        set(options ${GONIO_TEST_OPTIONS})
        set(headers gonio_test_headers)
    endif()
    target_compile_options(${name} PRIVATE ${options})
    if(GONIO_PRECOMPILE)
        target_precompile_headers(${name} REUSE_FROM ${headers})
    endif()
    if(TEST_WRAPPER)
        set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "${TEST_WRAPPER}")
    endif()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
        PROPERTIES LABELS "${TEST_LABEL}" TIMEOUT ${TEST_TIMEOUT} COST ${TEST_COST})
endfunction()

function(uses_programs name)
    target_compile_definitions(${name} PRIVATE
        GONIO_PROGRAM="$<TARGET_FILE:gonio>" GONIO_DAEMON="$<TARGET_FILE:goniod>")
    add_dependencies(${name} gonio goniod)
endfunction()

function(gonio_program_test name)
    gonio_test(${name} RUNS_PROGRAMS ${ARGN})
    uses_programs(${name})
endfunction()
