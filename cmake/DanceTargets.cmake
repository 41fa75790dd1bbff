# dance_library and dance_program, and dance_test and dance_fuzz in DanceTests.cmake: every target of the tree is made by one
# of these, so that standard, warnings, sanitizers and include root are the same everywhere and are properties of targets.
include_guard(GLOBAL)

# g++ collects garbage less often, which saves compile time, until its heap has a quarter of the memory of each processor, and
# at most 64 MiB: the page faults of a larger one take more time than they save.
cmake_host_system_information(RESULT DANCE_COMPILER_HEAP_KIB QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR DANCE_COMPILER_HEAP_KIB "${DANCE_COMPILER_HEAP_KIB} * 256 / ${processors}")
if(DANCE_COMPILER_HEAP_KIB GREATER 65536)
  set(DANCE_COMPILER_HEAP_KIB 65536)
endif()

add_library(dance_settings INTERFACE)
target_compile_features(dance_settings INTERFACE cxx_std_20)
target_include_directories(dance_settings INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(dance_settings INTERFACE
  -Wall -Wextra -Wpedantic $<$<NOT:$<BOOL:$<TARGET_PROPERTY:DANCE_MAY_SHADOW>>>:-Wshadow> -Wconversion -Wno-sign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
  -ffp-contract=off $<$<BOOL:${DANCE_WERROR}>:-Werror>
  $<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-expand=400 --param ggc-min-heapsize=${DANCE_COMPILER_HEAP_KIB}>
  # g++ 12 sees overlapping copies in "text" + std::string that are not there (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # In a unity build the sources are included files, of which g++ takes anonymous namespaces amiss.
  $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>)
# Debian's hardening, and checks of indices in the standard library; the sanitizers have their own. Binaries do not name the
# folder that they were built in.
target_compile_options(dance_settings INTERFACE -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(NOT DANCE_SANITIZE)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-fcf-protection DANCE_HAVE_CF_PROTECTION)
  target_compile_options(dance_settings INTERFACE -fstack-protector-strong -fstack-clash-protection
    $<$<BOOL:${DANCE_HAVE_CF_PROTECTION}>:-fcf-protection> $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
  target_compile_definitions(dance_settings INTERFACE _GLIBCXX_ASSERTIONS)
  target_link_options(dance_settings INTERFACE -Wl,-z,relro -Wl,-z,now)
endif()
# The sanitizers' own code, and optimisation that is only begun, make g++ 12 see uninitialised values and overruns in the
# standard library that are not there; the libraries and programs of the ci build look for the real ones.
set(DANCE_FALSE_WARNINGS_OFF
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread>)
if(DANCE_SANITIZE)
  # Of the undefined behaviour all but what costs Eigen a third of its building time and the address sanitizer or Eigen's
  # own assertions see as well.
  target_compile_options(dance_settings INTERFACE
    -fsanitize=${DANCE_SANITIZE} -fno-sanitize=null,alignment,object-size -fno-sanitize-recover=all
    -fno-omit-frame-pointer ${DANCE_FALSE_WARNINGS_OFF})
  target_compile_options(dance_settings INTERFACE
    $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizer_ignorelist.txt>)
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
  # In a unit of several tests a local name may shadow a constant of another test.
  set_target_properties(${target} PROPERTIES DANCE_MAY_SHADOW "${CMAKE_UNITY_BUILD}")
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
  if("GTest::gtest" IN_LIST libraries)
    set(pch dance_test_pch)
    set(more <gtest/gtest.h>)
    # clang accepts a precompiled header only if it was made with the same optimisation.
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
      dance_use_test_options(${target})
    endif()
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
      target_link_libraries(${pch} PRIVATE GTest::gtest)
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
