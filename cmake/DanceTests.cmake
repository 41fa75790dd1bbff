# dance_test and dance_fuzz add the tests of a folder to the test programs of its top-level folder, and register them with CTest.
include_guard(GLOBAL)

# The thread sanitizer is for thread_targets, tests in which threads meet, and for flow_targets, which start programs with
# several threads. test_targets is what `./dance test` builds, long_test_targets is what only `--all` builds.
foreach(kind thread flow test long_test)
  add_custom_target(${kind}_targets)
endforeach()

# Sets `result` to the top-level folder of tests/ that contains the calling CMakeLists.txt.
function(dance_test_folder result)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "/.*" "" folder ${folder})
  set(${result} ${folder} PARENT_SCOPE)
endfunction()

# dance_test(NAME LABEL unit|threads|flow|golden|soak SOURCES x_test.cpp … LIBS targets …
#   [TIMEOUT s] [PRELOAD x.so] [BESIDE_OTHERS KIND] [FLOODS] [THREADS] [EACH_TEST | WHOLE] [ALONE FOLDER]
#   [LONG] [LONG_TESTS Suite.Test …] [UNSANITIZED Suite.Test …] [NO_TSAN Suite.Test …]): a group of GoogleTest sources.
#
# The sources become part of the program <folder>_tests of the top-level folder, or of <folder>_long_tests with LONG. With ALONE
# they become a program of their own in tests/FOLDER.
#
# By default CTest has one entry per suite. Flow groups and EACH_TEST have one entry per test: use EACH_TEST for tests that
# change their process. WHOLE makes one entry for the group: use it where the shared set-up takes longer than the tests.
# PRELOAD: the entries run with that library loaded before all others.
#
# A flow test runs in a network namespace of its own, and never beside another one of its KIND (clients, sound, cluster …; the
# default is `flow`). Flow tests have the ordinary priority and unit tests a low one, so that unit tests delay no program that dances.
# THREADS: a flow group with several threads in its own process, or in few programs. The thread sanitizer runs no other
# flow groups: their programs are mostly one thread each, and building all of them under it takes minutes.
# FLOODS: the tests use all processors for seconds, and run while no other test does.
#
# LONG and LONG_TESTS have the label `long` too: `./dance test` leaves them out. UNSANITIZED tests are left out under
# sanitizers, NO_TSAN ones under the thread sanitizer. All three are lists of regular expressions of whole names.
function(dance_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "WHOLE;EACH_TEST;LONG;FLOODS;THREADS" "LABEL;TIMEOUT;PRELOAD;BESIDE_OTHERS;ALONE"
    "SOURCES;LIBS;LONG_TESTS;UNSANITIZED;NO_TSAN")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "dance_test(${name}): unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  # This library holds what the program links for the group. add_dependencies and target_… (INTERFACE) accept its name.
  add_library(${name} INTERFACE)
  target_link_libraries(${name} INTERFACE ${arg_LIBS})
  if(DANCE_SANITIZE STREQUAL "thread" AND NOT arg_LABEL STREQUAL "threads" AND NOT arg_THREADS)
    return()
  endif()
  set(sources "")
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(source ${source} ABSOLUTE)
    list(APPEND sources ${source})
  endforeach()

  # In a program of long tests each group is a unity file of its own: constants of different groups share names.
  set_source_files_properties(${sources} DIRECTORY ${PROJECT_SOURCE_DIR}/tests PROPERTIES UNITY_GROUP ${name})
  set(targets test_targets)
  dance_test_folder(program)
  set(program ${program}_tests)
  if(arg_LONG)
    dance_test_folder(program)
    set(program ${program}_long_tests)
    set(targets long_test_targets)
  endif()
  if(arg_ALONE)
    set(program ${arg_ALONE}_tests)
    set_property(GLOBAL PROPERTY DANCE_FOLDER_OF_${program} /${arg_ALONE})
  endif()
  # The thread sanitizer runs no long programs.
  if(arg_LABEL STREQUAL "threads" AND NOT arg_LONG)
    list(APPEND targets thread_targets)
  elseif(arg_LABEL STREQUAL "flow" AND NOT arg_LONG)
    list(APPEND targets flow_targets)
  endif()
  set_property(GLOBAL APPEND PROPERTY DANCE_TEST_PROGRAMS ${program})
  set_property(GLOBAL APPEND PROPERTY DANCE_GROUPS_OF_${program} ${name})
  set_property(GLOBAL APPEND PROPERTY DANCE_SOURCES_OF_${program} ${sources})
  set_property(GLOBAL APPEND PROPERTY DANCE_TARGETS_OF_${program} ${targets})

  # The rest of this function describes the group for CTest; dance_write_tests writes it.
  # Flow tests mostly wait, so that many run at once; the others compute: CTest counts one of them as three.
  set(launcher "nice;-n;10")
  set(properties COST 0 PROCESSORS 3)
  if(arg_TIMEOUT)
    set(properties COST 50 PROCESSORS 3)
  else()
    set(arg_TIMEOUT 600) # for a whole suite
  endif()
  if(DANCE_SANITIZE)
    math(EXPR arg_TIMEOUT "2 * ${arg_TIMEOUT}")
  endif()
  if(arg_LABEL STREQUAL "flow")
    set(launcher ${PROJECT_SOURCE_DIR}/tests/private_network.sh)
    set(lock flow)
    if(arg_BESIDE_OTHERS)
      set(lock ${arg_BESIDE_OTHERS})
    endif()
    # Programs of others use all processors for seconds while they start.
    if(lock STREQUAL "clients")
      list(PREPEND launcher nice -n 5)
    endif()
    set(properties COST 100 RESOURCE_LOCK ${lock})
    if(arg_FLOODS)
      list(APPEND properties RUN_SERIAL ON)
    endif()
  elseif(arg_LABEL STREQUAL "threads")
    set(launcher "")
  endif()
  if(arg_PRELOAD)
    list(APPEND properties ENVIRONMENT_MODIFICATION "LD_PRELOAD=set:${DANCE_PRELOAD_FIRST}${arg_PRELOAD}")
  endif()
  set(each suite)
  if(arg_WHOLE)
    set(each whole)
  elseif(arg_EACH_TEST OR arg_LABEL STREQUAL "flow")
    set(each test)
  endif()
  if(NOT DANCE_SANITIZE)
    set(arg_UNSANITIZED "")
  elseif(DANCE_SANITIZE STREQUAL "thread")
    list(APPEND arg_UNSANITIZED ${arg_NO_TSAN})
  endif()
  set(label ${arg_LABEL})
  if(arg_LONG)
    list(APPEND label long)
  endif()
  set_property(GLOBAL APPEND PROPERTY DANCE_LABELS_OF_${program} ${label})
  # Programs under test make keys for this machine; they must not use the keys of the user who runs the tests.
  list(APPEND properties TIMEOUT ${arg_TIMEOUT} ENVIRONMENT "XDG_CONFIG_HOME=${PROJECT_BINARY_DIR}/test-config")
  set(table "dance_group(${name} ${each} \"${label}\" \"${launcher}\" \"${properties}\" \"${arg_LONG_TESTS}\" \"${arg_UNSANITIZED}\"")
  # Names are relative, like __FILE__: -ffile-prefix-map removes the source folder.
  foreach(source IN LISTS sources)
    file(RELATIVE_PATH source ${PROJECT_SOURCE_DIR} ${source})
    string(APPEND table "\n  \"${source}\"")
  endforeach()
  set_property(GLOBAL APPEND_STRING PROPERTY DANCE_TABLE_OF_${program} "${table})\n")
endfunction()

# dance_fuzz(NAME SOURCES x_fuzz.cpp LIBS targets … CORPUS dir): the fuzz target NAME, which x_fuzz.cpp defines with
# DANCE_FUZZ_TARGET (tests/fuzz_target.h). With DANCE_FUZZ it is part of the libFuzzer program fuzz/<folder>_fuzz; otherwise
# tests/<folder>_fuzz replays the corpus and its mutations.
function(dance_fuzz name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "CORPUS" "SOURCES;LIBS")
  if(DANCE_SANITIZE AND NOT DANCE_FUZZ)
    return()
  endif()
  get_filename_component(corpus "${arg_CORPUS}" ABSOLUTE BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR})
  dance_test_folder(folder)
  set_property(GLOBAL APPEND PROPERTY DANCE_FUZZ_PROGRAMS ${folder}_fuzz)
  get_filename_component(sources ${arg_SOURCES} ABSOLUTE)
  set_property(GLOBAL APPEND PROPERTY DANCE_SOURCES_OF_${folder}_fuzz ${sources})
  set_property(GLOBAL APPEND PROPERTY DANCE_LIBS_OF_${folder}_fuzz ${arg_LIBS})
  if(DANCE_FUZZ)
    # libFuzzer writes new inputs into its corpus folder, so it gets a copy.
    file(COPY ${corpus}/ DESTINATION ${PROJECT_BINARY_DIR}/fuzz/corpus_${name})
    set_property(GLOBAL APPEND_STRING PROPERTY DANCE_FUZZ_LIST "${folder}_fuzz ${name}\n")
  else()
    add_test(NAME fuzz.${name} COMMAND nice -n 10 ${PROJECT_BINARY_DIR}/tests/${folder}_fuzz ${name} ${corpus})
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 300 PROCESSORS 3)
  endif()
endfunction()

# Makes the programs of all groups, and the list by which CTest finds their tests. Call it once, at the end.
function(dance_write_tests)
  add_library(dance_test_main OBJECT ${PROJECT_SOURCE_DIR}/tests/test_main.cpp)
  target_link_libraries(dance_test_main PRIVATE dance_settings GTest::gtest)
  get_property(programs GLOBAL PROPERTY DANCE_TEST_PROGRAMS)
  list(REMOVE_DUPLICATES programs)
  set(script "include(\"${PROJECT_SOURCE_DIR}/cmake/TestEntries.cmake\")\n")
  foreach(program IN LISTS programs)
    foreach(kind groups sources targets table folder labels)
      string(TOUPPER ${kind} property)
      get_property(${kind} GLOBAL PROPERTY DANCE_${property}_OF_${program})
    endforeach()
    list(REMOVE_DUPLICATES sources)
    list(REMOVE_DUPLICATES labels)
    add_executable(${program} ${sources})
    dance_use_test_options(${program})
    target_link_libraries(${program} PRIVATE dance_settings dance_test_main ${groups} GTest::gtest)
    target_compile_definitions(${program} PRIVATE
      DANCE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" DANCE_BINARY_DIR="${PROJECT_BINARY_DIR}")
    foreach(group IN LISTS groups)
      get_target_property(libraries ${group} INTERFACE_LINK_LIBRARIES)
      # CMake does not pass an object library's objects through an INTERFACE library.
      if("dance::allocation_guard" IN_LIST libraries)
        target_link_libraries(${program} PRIVATE dance_allocation_guard)
      endif()
    endforeach()
    dance_use_pch(${program})
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests${folder})
    if(program MATCHES "_long_tests$")
      set_target_properties(${program} PROPERTIES UNITY_BUILD_MODE GROUP)
    endif()
    foreach(target IN LISTS targets)
      add_dependencies(${target} ${program})
    endforeach()
    string(APPEND script "${table}dance_add_entries(\"${PROJECT_BINARY_DIR}/tests${folder}/${program}\" \"${labels}\")\n")
  endforeach()
  file(WRITE ${PROJECT_BINARY_DIR}/tests/entries.cmake "${script}")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${PROJECT_BINARY_DIR}/tests/entries.cmake)

  get_property(programs GLOBAL PROPERTY DANCE_FUZZ_PROGRAMS)
  list(REMOVE_DUPLICATES programs)
  foreach(program IN LISTS programs)
    get_property(sources GLOBAL PROPERTY DANCE_SOURCES_OF_${program})
    get_property(libraries GLOBAL PROPERTY DANCE_LIBS_OF_${program})
    add_executable(${program} ${sources} ${PROJECT_SOURCE_DIR}/tests/field_mutation.cpp
      ${PROJECT_SOURCE_DIR}/tests/fuzz_target.cpp)
    target_link_libraries(${program} PRIVATE dance_settings ${libraries})
    dance_use_pch(${program})
    if(DANCE_FUZZ)
      target_link_options(${program} PRIVATE -fsanitize=fuzzer)
      target_compile_definitions(${program} PRIVATE DANCE_LIBFUZZER=1)
      set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
    else()
      target_sources(${program} PRIVATE ${PROJECT_SOURCE_DIR}/tests/fuzz_replay_main.cpp)
      set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    endif()
    add_dependencies(test_targets ${program})
  endforeach()
  if(DANCE_FUZZ)
    get_property(list GLOBAL PROPERTY DANCE_FUZZ_LIST)
    file(WRITE ${PROJECT_BINARY_DIR}/fuzz/targets.txt "${list}")
  endif()
endfunction()
