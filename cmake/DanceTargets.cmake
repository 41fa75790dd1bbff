# dance_library, dance_program, dance_test and dance_fuzz: every target of the tree is made by one of these, so that
# standard, warnings, sanitizers and include root are the same everywhere and are properties of targets.
include_guard(GLOBAL)

add_library(dance_settings INTERFACE)
target_compile_features(dance_settings INTERFACE cxx_std_20)
target_include_directories(dance_settings INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(dance_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
  -ffp-contract=off $<$<BOOL:${DANCE_WERROR}>:-Werror>
  # g++ 12 sees overlapping copies in "text" + std::string that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # In a unity build the sources are included files, of which g++ takes anonymous namespaces amiss.
  $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>)
# The sanitizers' own code, and optimisation that is only begun, make g++ 12 see uninitialised values and overruns in the
# standard library that are not there; the libraries and programs of the ci build look for the real ones.
set(DANCE_FALSE_WARNINGS_OFF
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
if(DANCE_SANITIZE)
  # Of the undefined behaviour all but what costs Eigen a third of its building time and the address sanitizer or Eigen's
  # own assertions see as well.
  target_compile_options(dance_settings INTERFACE
    -fsanitize=${DANCE_SANITIZE} -fno-sanitize=null,alignment,object-size -fno-sanitize-recover=all
    -fno-omit-frame-pointer -g1 -O1 ${DANCE_FALSE_WARNINGS_OFF})
  target_link_options(dance_settings INTERFACE -fsanitize=${DANCE_SANITIZE})
  # Two hundred programs, four times as fast.
  find_program(DANCE_LLD ld.lld)
  if(DANCE_LLD)
    target_link_options(dance_settings INTERFACE -fuse-ld=lld)
  endif()
  target_compile_definitions(dance_settings INTERFACE DANCE_SANITIZED=1)
endif()
# g++'s sanitizers are libraries that want to be loaded before any other; clang's are part of the program.
set(DANCE_PRELOAD_FIRST "")
if(DANCE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  string(REGEX MATCH "address|thread" sanitizer "${DANCE_SANITIZE}")
  string(REPLACE "address" "asan" sanitizer "${sanitizer}")
  string(REPLACE "thread" "tsan" sanitizer "${sanitizer}")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${sanitizer}.so
    OUTPUT_VARIABLE runtime OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(DANCE_PRELOAD_FIRST "${runtime}:")
endif()
# Fuzz targets find their way by the coverage of what reads bytes of others; counting it costs other code two fifths of its
# speed. A folder that no fuzz target leads to says set(DANCE_COVERAGE OFF), and dance_cover(source …) for what one does.
set(DANCE_COVERAGE ${DANCE_FUZZ})
if(DANCE_FUZZ)
  target_link_options(dance_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()

function(dance_use_coverage target)
  if(DANCE_COVERAGE)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

function(dance_cover)
  if(DANCE_FUZZ)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -fsanitize=fuzzer-no-link
      SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

function(dance_use_test_options target)
  if(DANCE_TEST_OPTIONS)
    target_compile_options(${target} PRIVATE ${DANCE_TEST_OPTIONS} ${DANCE_FALSE_WARNINGS_OFF})
  endif()
endfunction()

# What most files include, read once for all targets. Like unity builds (a quarter of the time) it hides a forgotten
# #include: the dev preset has neither. Of optimised code g++ 12 sees overruns in precompiled headers that are not there:
# the ci build has them for test programs alone, which it does not optimise.
function(dance_use_pch target)
  if(NOT DANCE_PCH)
    return()
  endif()
  # Several, as coverage and GoogleTest bring options that a precompiled header must have been made with.
  get_target_property(libraries ${target} LINK_LIBRARIES)
  set(pch dance_pch)
  set(more "")
  if(DANCE_COVERAGE)
    set(pch dance_covered_pch)
  endif()
  if("GTest::gtest_main" IN_LIST libraries)
    set(pch dance_test_pch)
    set(more <gtest/gtest.h>)
  elseif(DANCE_PCH STREQUAL "TESTS")
    return()
  endif()
  if(NOT TARGET ${pch})
    file(WRITE ${PROJECT_BINARY_DIR}/pch.cpp "")
    add_library(${pch} OBJECT ${PROJECT_BINARY_DIR}/pch.cpp)
    target_link_libraries(${pch} PRIVATE dance_settings Eigen3::Eigen tl::expected)
    dance_use_coverage(${pch})
    if(more)
      dance_use_test_options(${pch})
      target_link_libraries(${pch} PRIVATE GTest::gtest_main)
    endif()
    target_precompile_headers(${pch} PRIVATE <Eigen/Geometry> <algorithm> <array> <functional> <memory> <optional>
      <span> <string> <string_view> <tl/expected.hpp> <vector> ${more})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${pch})
endfunction()

# dance_library(NAME SOURCES a.cpp … PUBLIC targets … PRIVATE targets … [PIC]): static library dance_NAME, alias
# dance::NAME; PIC where it becomes part of a shared library. (A precompiled header is not made so.)
function(dance_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PIC" "" "SOURCES;PUBLIC;PRIVATE")
  add_library(dance_${name} STATIC ${arg_SOURCES})
  add_library(dance::${name} ALIAS dance_${name})
  target_link_libraries(dance_${name} PUBLIC $<BUILD_INTERFACE:dance_settings> ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  dance_use_coverage(dance_${name})
  if(arg_PIC)
    set_target_properties(dance_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  else()
    dance_use_pch(dance_${name})
  endif()
endfunction()

# dance_embed(TARGET NAME FILE): the file's bytes are part of the target, std::span<const std::uint8_t> dance::NAME().
function(dance_embed target name file)
  set(file ${PROJECT_SOURCE_DIR}/${file})
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/embedded_file.cpp.in ${source} @ONLY)
  # In a unity source a dependency of one of its parts would not count.
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS ${file} SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${source})
endfunction()

# dance_program(NAME SOURCES x_main.cpp … LIBS targets … [NEEDS targets …]): the program dance-NAME in <build>/bin. NEEDS is
# what must have been built when it runs: each program that it starts, and those that these start for it. It is the one place
# that says so: ./dance builds by it. What a configuration leaves out may stand there too.
function(dance_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBS;NEEDS")
  add_executable(dance-${name} ${arg_SOURCES})
  target_link_libraries(dance-${name} PRIVATE dance_settings ${arg_LIBS})
  dance_use_coverage(dance-${name})
  dance_use_pch(dance-${name})
  set_target_properties(dance-${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set_property(GLOBAL APPEND PROPERTY DANCE_PROGRAMS dance-${name})
  if(NOT name STREQUAL "front")
    dance_command(${name} dance-${name} ${arg_NEEDS})
  endif()
endfunction()

# dance_command(NAME targets …): `./dance NAME` builds these.
function(dance_command name)
  set_property(GLOBAL APPEND PROPERTY DANCE_COMMANDS ${name})
  set_property(GLOBAL PROPERTY DANCE_TARGETS_OF_${name} ${ARGN})
endfunction()

# The list of commands, one a line: its name with - between words, and the targets that ./dance builds for it. `dance help`
# shows what stands there, too.
function(dance_write_commands)
  get_property(commands GLOBAL PROPERTY DANCE_COMMANDS)
  set(lines "")
  foreach(command IN LISTS commands)
    get_property(needs GLOBAL PROPERTY DANCE_TARGETS_OF_${command})
    set(targets dance-front)
    foreach(target IN LISTS needs)
      if(TARGET ${target})
        list(APPEND targets ${target})
      endif()
    endforeach()
    list(REMOVE_DUPLICATES targets)
    list(JOIN targets " " targets)
    string(APPEND lines "${command} ${targets}\n")
  endforeach()
  file(WRITE ${PROJECT_BINARY_DIR}/share/dancegraph/commands.txt "${lines}")
endfunction()

# dance_test(NAME LABEL unit|threads|flow|golden|soak SOURCES x_test.cpp … LIBS targets … [TIMEOUT s] [PRELOAD x.so]
# [BESIDE_OTHERS KIND] [WHOLE]): one GoogleTest program, run with that library loaded before all others. One CTest entry per
# TEST; WHOLE: one in all, where making what the tests share takes longer than they do (what skips in it is not counted). A
# flow test runs in a network namespace of its own, one at a time of its kind (clients, sound, programs, cluster, tunnel, house, or the usual one),
# at the ordinary priority: unit tests have the lowest, so that they fill the processors and hold up no program that dances.
# What takes long begins first.
# thread_targets are those in which threads meet, flow_targets those in which programs do: what the thread sanitizer is for.
add_custom_target(thread_targets)
add_custom_target(flow_targets)
function(dance_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "WHOLE" "LABEL;TIMEOUT;PRELOAD;BESIDE_OTHERS" "SOURCES;LIBS")
  add_executable(${name} ${arg_SOURCES})
  dance_use_test_options(${name})
  target_link_libraries(${name} PRIVATE dance_settings ${arg_LIBS} GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    DANCE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" DANCE_BINARY_DIR="${PROJECT_BINARY_DIR}")
  dance_use_pch(${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  set(cost 50)
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
    set(cost 0)
  endif()
  if(arg_LABEL STREQUAL "threads")
    add_dependencies(thread_targets ${name})
  endif()
  if(arg_LABEL STREQUAL "flow")
    add_dependencies(flow_targets ${name})
    set(emulator ${PROJECT_SOURCE_DIR}/tests/private_network.sh)
    # Programs of others that start for seconds.
    if(arg_BESIDE_OTHERS STREQUAL "clients")
      list(PREPEND emulator nice -n 5)
    endif()
    set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "${emulator}")
    set(cost 100)
    set(serial RESOURCE_LOCK flow)
    if(arg_BESIDE_OTHERS)
      set(serial RESOURCE_LOCK ${arg_BESIDE_OTHERS})
    endif()
  elseif(NOT arg_LABEL STREQUAL "threads")
    set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR "nice;-n;19")
  endif()
  set(preload "")
  if(arg_PRELOAD)
    set(preload ENVIRONMENT_MODIFICATION "LD_PRELOAD=set:${DANCE_PRELOAD_FIRST}${arg_PRELOAD}")
  endif()
  if(arg_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL} TIMEOUT 600 COST 50)
    return()
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    # The keys that programs make for this machine are not those of the user who runs the tests.
    PROPERTIES LABELS ${arg_LABEL} TIMEOUT ${arg_TIMEOUT} COST ${cost}
      ENVIRONMENT "XDG_CONFIG_HOME=${PROJECT_BINARY_DIR}/test-config" SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]" ${serial} ${preload})
endfunction()

# dance_fuzz(NAME SOURCES x_fuzz.cpp LIBS targets … CORPUS dir): with DANCE_FUZZ a libFuzzer program fuzz/NAME; in a build
# without sanitizers the same source is replayed over the corpus and its mutations by tests/fuzz_replay_main.cpp.
function(dance_fuzz name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "CORPUS" "SOURCES;LIBS")
  if(DANCE_SANITIZE AND NOT DANCE_FUZZ)
    return()
  endif()
  get_filename_component(corpus "${arg_CORPUS}" ABSOLUTE BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR})
  if(DANCE_FUZZ)
    add_executable(fuzz_${name} ${arg_SOURCES})
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    set_target_properties(fuzz_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
    # It adds what it finds: to a copy.
    file(COPY ${corpus}/ DESTINATION ${PROJECT_BINARY_DIR}/fuzz/corpus_fuzz_${name})
  else()
    add_executable(fuzz_${name} ${arg_SOURCES} ${PROJECT_SOURCE_DIR}/tests/fuzz_replay_main.cpp)
    set_target_properties(fuzz_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    add_test(NAME fuzz.${name} COMMAND fuzz_${name} ${corpus})
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 300)
  endif()
  target_link_libraries(fuzz_${name} PRIVATE dance_settings ${arg_LIBS})
  dance_use_pch(fuzz_${name})
endfunction()
