# Tests that configure and build: other configurations of the project, projects that use it, and its style. Those with
# the label `full` are left out by tests/run --change, and those with the label `change` by tests/run --all: they test
# only what has changed, see tiers/selection.py.
set(changes ${PROJECT_BINARY_DIR}/changes)
set(nested_options --build-generator ${CMAKE_GENERATOR} --build-noclean)
set(nested_parallel 2)

# Builds the project in another folder with these options, and runs its tests.
#   FOLDER    below configurations/, if not the name
#   LABELS    besides `config`
#   TARGET    build only this target
#   TESTS     run only the tests that match this
#   LEAVE_OUT do not run those that match this
#   PARALLEL  number of tests at once, if not the number of processors
#   OPTIONS   options of the configuration
function(tetskin_test_configuration name)
  cmake_parse_arguments(arg "" "FOLDER;TARGET;TESTS;LEAVE_OUT;PARALLEL" "LABELS;OPTIONS" ${ARGN})
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
  endif()
  set(target_option)
  if(arg_TARGET)
    set(target_option --build-target ${arg_TARGET})
  endif()
  if(NOT arg_TESTS)
    set(arg_TESTS .)
  endif()
  set(leave_out)
  if(arg_LEAVE_OUT)
    set(leave_out -E ${arg_LEAVE_OUT})
  endif()
  if(NOT arg_PARALLEL)
    set(arg_PARALLEL ${nested_parallel})
  endif()
  add_test(NAME configuration.${name}
    COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/configurations/${arg_FOLDER}
      ${nested_options} ${target_option}
      --build-options ${arg_OPTIONS} -DTETSKIN_TEST_CONFIGURATIONS=OFF -DTETSKIN_WARNINGS_AS_ERRORS=ON
      --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure --no-tests=error --parallel ${arg_PARALLEL}
      -R ${arg_TESTS} ${leave_out})
  set_tests_properties(configuration.${name} PROPERTIES TIMEOUT 3600 PROCESSORS ${nested_parallel}
    LABELS "config;${arg_LABELS}")
endfunction()

# The fuzzers and the sanitized tests are compiled by clang if it is installed with its runtime: it takes two thirds of
# GCC's time, and is a second compiler.
set(sanitizing_compiler)
if(has_fuzzer_runtime)
  set(sanitizing_compiler -DCMAKE_CXX_COMPILER=${CLANG_CXX})
endif()
# With Bullet in double precision: code that depends on it is tested in float by all other builds, and everything else
# is templates, tested for both. Without the demos, which take longer to build this way than everything else; without
# the fuzzers, which have a configuration of their own; and without the tests in without_sanitizers.txt.
# replay.heap and others are long runs: replay.drop is restored in a new process, too.
function(tetskin_test_sanitized name label folders_from)
  tetskin_test_configuration(${name} FOLDER sanitized_in_double LABELS ${label} TARGET unit_tests
    TESTS "^(core|threads|cage|elastic|io|bullet|solver|contact|touch|reduced|replay|world)[.]"
    LEAVE_OUT "^(replay[.](heap|drag|twist|pit|changing|Deterministic|RecordedCallsFromAllBeginnings)|solver[.]EveryNumberInAllCells)"
    OPTIONS ${sanitizing_compiler} -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O2 -g1"
    -DTETSKIN_SANITIZE=address,undefined -DTETSKIN_DOUBLE_PRECISION=ON -DTETSKIN_DEMOS=OFF
    -DTETSKIN_TEST_FOLDERS_FROM=${folders_from})
endfunction()
tetskin_test_sanitized(sanitized_in_double full "")
tetskin_test_sanitized(sanitized_changes change ${changes}/tests)
set_tests_properties(configuration.sanitized_in_double configuration.sanitized_changes PROPERTIES
  RESOURCE_LOCK sanitized_folder)

# The tests that start threads, including those beside Bullet's worlds. The thread sanitizer lets no forked process start
# threads.
tetskin_test_configuration(thread_sanitized TARGET test_threads TESTS ^threads LEAVE_OUT ThatWasForked OPTIONS
  -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1" -DTETSKIN_SANITIZE=thread -DTETSKIN_DEMOS=OFF
  -DTETSKIN_CAGE=OFF -DTETSKIN_ELASTIC=OFF -DTETSKIN_REDUCED=OFF -DTETSKIN_IO=OFF)

# The fuzzers, all four at once: by libFuzzer if there is a clang with its runtime, otherwise by our random driver. This
# also tests that the rest configures, links and runs without the parts left out.
set(TETSKIN_FUZZ_LONG 90 CACHE STRING "Seconds that configuration.fuzzed runs each fuzzer for")
set(fuzzed_sanitizers address,undefined)
if(has_fuzzer_runtime)
  set(fuzzed_sanitizers fuzzer-no-link,address,undefined)
endif()
tetskin_test_configuration(fuzzed TARGET fuzzers TESTS ^fuzz PARALLEL 4 OPTIONS ${sanitizing_compiler}
  -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1" -DTETSKIN_SANITIZE=${fuzzed_sanitizers}
  -DTETSKIN_FUZZ_SECONDS=${TETSKIN_FUZZ_LONG} -DTETSKIN_BULLET=OFF -DTETSKIN_CAGE=OFF -DTETSKIN_ELASTIC=OFF
  -DTETSKIN_THREADS=OFF -DTETSKIN_DEMOS=OFF)
set_tests_properties(configuration.fuzzed PROPERTIES LABELS "fuzz;full")

# Files without assimp, which is not even looked for.
tetskin_test_configuration(without_assimp LABELS full TARGET test_io TESTS ^io OPTIONS -DCMAKE_BUILD_TYPE=Debug
  "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1" -DTETSKIN_ASSIMP=OFF -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON -DTETSKIN_BULLET=OFF
  -DTETSKIN_CAGE=OFF -DTETSKIN_ELASTIC=OFF -DTETSKIN_THREADS=OFF -DTETSKIN_DEMOS=OFF)

# The Python package: its wheel, made once from the checkout; installed; beside the packages of its demos, which are run;
# and, with all tests, as a wheel of a staged source package, by other Pythons, and in a system that has nothing but
# Python.
set(command_wheel run --wheel ${PROJECT_BINARY_DIR}/python/made)
set(command_package run)
set(command_beside_others run --beside)
set(command_staged_package run --staged)
set(command_versions run --versions)
set(command_fresh_root root)
foreach(way IN ITEMS wheel package beside_others staged_package versions fresh_root)
  list(POP_FRONT command_${way} script)
  add_test(NAME python.${way} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/python/${script} ${command_${way}})
  set_tests_properties(python.${way} PROPERTIES LABELS "config;python" TIMEOUT 3600 SKIP_RETURN_CODE 77
    RESOURCE_LOCK python_build FIXTURES_REQUIRED python_wheel)
  if(way MATCHES "staged|versions|root")
    set_property(TEST python.${way} APPEND PROPERTY LABELS full)
  endif()
endforeach()
set_tests_properties(python.wheel PROPERTIES FIXTURES_REQUIRED "" FIXTURES_SETUP python_wheel)
# How the wheel comes by objects of the main build.
if(PYTHON_OF_SYSTEM AND CMAKE_GENERATOR STREQUAL "Ninja")
  add_test(NAME python.same_object COMMAND ${PYTHON_OF_SYSTEM} -B ${CMAKE_CURRENT_SOURCE_DIR}/python/same_object.py)
  set_tests_properties(python.same_object PROPERTIES LABELS "config;python" TIMEOUT 60)
endif()
set_tests_properties(python.wheel python.staged_package PROPERTIES RESOURCE_LOCK "python_build;bullet_sources")
# ctest starts what takes several processors only when all others have ended. Then one would be idle for the minutes that
# the tests of the wheel and the live page take: these begin first, beside short ones.
set_tests_properties(python.staged_package PROPERTIES PROCESSORS ${nested_parallel})
set_tests_properties(python.wheel PROPERTIES COST 2000)
set_tests_properties(python.package python.beside_others PROPERTIES COST 900)

# The module for JavaScript in Node, and the live page in headless Chromium: both are built in one folder, by one test
# at a time, which compiles what has changed since the last one. Without Emscripten, Node or Chromium they are skipped.
# tests/run --change runs one scene where only the library below them has changed.
set(command_js.module js/run)
set(command_live.driver live/run --driver)
set(command_live.one_scene live/run --one-scene)
set(command_live.page live/run)
foreach(test IN ITEMS js.module live.driver live.one_scene live.page)
  list(POP_FRONT command_${test} script)
  add_test(NAME ${test} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/${script} ${command_${test}})
  set_tests_properties(${test} PROPERTIES LABELS "config;js" TIMEOUT 3600 SKIP_RETURN_CODE 77)
  set_property(TEST ${test} PROPERTY RESOURCE_LOCK js_build bullet_sources)
endforeach()
set_property(TEST live.one_scene APPEND PROPERTY LABELS change)
set_tests_properties(js.module live.one_scene live.page PROPERTIES
  ENVIRONMENT TETSKIN_LIVE_NATIVE=$<$<TARGET_EXISTS:tetskin_live_native>:$<TARGET_FILE:tetskin_live_native>>)
set_tests_properties(live.page live.one_scene PROPERTIES COST 1000)
set_tests_properties(live.driver PROPERTIES TIMEOUT 300)

# A project that uses the library, through the installed package and as a subdirectory; it runs what it has built.
set(labels_full "config;full")
function(tetskin_test_consumer name)
  add_test(NAME consumer.${name}
    COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer
      ${PROJECT_BINARY_DIR}/consumers/${name} ${nested_options}
      --build-options -DCMAKE_BUILD_TYPE=Release -DSOURCE=${PROJECT_SOURCE_DIR} ${ARGN}
      --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure --no-tests=error)
  set_tests_properties(consumer.${name} PROPERTIES TIMEOUT 1200 LABELS "${labels_full}")
endfunction()

# The package of io without assimp: neither its users nor their CMake need it.
set(own_formats ${PROJECT_BINARY_DIR}/consumers/own_formats_prefix)
add_test(NAME consumer.own_formats_install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR}/configurations/without_assimp --prefix ${own_formats})
set_tests_properties(configuration.without_assimp PROPERTIES FIXTURES_SETUP built_without_assimp)
set_tests_properties(consumer.own_formats_install PROPERTIES FIXTURES_SETUP own_formats
  FIXTURES_REQUIRED built_without_assimp LABELS "${labels_full}")
tetskin_test_consumer(own_formats -DCMAKE_PREFIX_PATH=${own_formats} -DCONSUME=io)
set_tests_properties(consumer.own_formats PROPERTIES FIXTURES_REQUIRED own_formats)

if(TETSKIN_INSTALL AND PYTHON_IN_PATH)
  # The installation that the other tests use is made as the README says, without any earlier build.
  set(prefix ${PROJECT_BINARY_DIR}/consumers/prefix)
  add_test(NAME consumer.readme COMMAND ${PYTHON_IN_PATH} -B ${CMAKE_CURRENT_SOURCE_DIR}/consumer/readme.py
    --folder ${PROJECT_BINARY_DIR}/consumers/readme --prefix ${prefix} --generator ${CMAKE_GENERATOR})
  add_test(NAME consumer.readme_changes COMMAND ${PYTHON_IN_PATH} -B ${CMAKE_CURRENT_SOURCE_DIR}/consumer/readme.py
    --folder ${PROJECT_BINARY_DIR}/consumers/readme_changes --prefix ${PROJECT_BINARY_DIR}/consumers/readme_prefix
    --generator ${CMAKE_GENERATOR})
  set_tests_properties(consumer.readme_changes PROPERTIES LABELS "config;change" TIMEOUT 1800 PROCESSORS ${nested_parallel})
  set_tests_properties(consumer.readme PROPERTIES FIXTURES_SETUP installed_package LABELS "${labels_full}" TIMEOUT 1800
    PROCESSORS ${nested_parallel})
  tetskin_test_consumer(installed_package -DCMAKE_PREFIX_PATH=${prefix} -DCONSUME=package)
  tetskin_test_consumer(installed_core_alone -DCMAKE_PREFIX_PATH=${prefix} -DCONSUME=core)
  tetskin_test_consumer(installed_bullet_alone -DCMAKE_PREFIX_PATH=${prefix} -DCONSUME=bullet)
  find_package(Eigen3 3.4 CONFIG REQUIRED)
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  add_test(NAME consumer.installed_headers
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DPREFIX=${prefix} -DCOMPILER=${CMAKE_CXX_COMPILER}
      -DEIGEN=${eigen}
      -DSTAGED=${PROJECT_BINARY_DIR}/include -P ${CMAKE_CURRENT_SOURCE_DIR}/consumer/installed_headers.cmake)
  if(PKG_CONFIG AND TARGET tetskin_bullet)
    add_test(NAME consumer.pkg_config
      COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DPREFIX=${prefix} -DCOMPILER=${CMAKE_CXX_COMPILER}
        -DPKG_CONFIG=${PKG_CONFIG} -DFOLDER=${PROJECT_BINARY_DIR}/consumers/pkg_config
        -P ${CMAKE_CURRENT_SOURCE_DIR}/consumer/pkg_config.cmake)
    set_tests_properties(consumer.pkg_config PROPERTIES FIXTURES_REQUIRED installed_package LABELS "${labels_full}")
  endif()
  # A project that enables only C is told what it lacks.
  set(c_project ${PROJECT_BINARY_DIR}/consumers/c_project)
  file(WRITE ${c_project}/CMakeLists.txt
    "cmake_minimum_required(VERSION 3.21)\nproject(app LANGUAGES C)\nfind_package(tetskin REQUIRED)\n")
  add_test(NAME consumer.of_c_alone COMMAND ${CMAKE_COMMAND} -S ${c_project} -B ${c_project}/build
    -DCMAKE_PREFIX_PATH=${prefix})
  set_tests_properties(consumer.of_c_alone PROPERTIES PASS_REGULAR_EXPRESSION "tetskin[^A-Za-z]+is[^A-Za-z]+a[^A-Za-z]+C[+][+]"
    FIXTURES_REQUIRED installed_package LABELS "${labels_full}")
  # The README's first program with compiler flags that the library was not compiled with: a change of layout or
  # allocation of a type by these flags must not matter.
  set(package -DCMAKE_PREFIX_PATH=${prefix} -DCONSUME=program -DCMAKE_BUILD_TYPE=None)
  tetskin_test_consumer(flags_avx2 ${package} "-DCMAKE_CXX_FLAGS=-O2 -mavx2 -mfma")
  tetskin_test_consumer(flags_native ${package} "-DCMAKE_CXX_FLAGS=-O2 -march=native")
  tetskin_test_consumer(flags_sanitized ${package}
    "-DCMAKE_CXX_FLAGS=-O1 -fsanitize=address,undefined -fno-sanitize-recover=all")
  set_tests_properties(consumer.installed_package consumer.installed_core_alone consumer.installed_bullet_alone
    consumer.installed_headers
    consumer.flags_avx2 consumer.flags_native consumer.flags_sanitized
    PROPERTIES FIXTURES_REQUIRED installed_package LABELS "${labels_full}")
  # Forms in which Bullet comes, made of Debian's. The programs link the installed libraries.
  if(UNIX AND NOT TETSKIN_DOUBLE_PRECISION)
    foreach(name vcpkg_like conan_like homebrew_like existing_targets application_flags no_avx)
      add_test(NAME platform.${name} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/platforms/${name})
      set_tests_properties(platform.${name} PROPERTIES FIXTURES_REQUIRED installed_package LABELS "${labels_full}"
        ENVIRONMENT TETSKIN_PREFIX=${prefix} SKIP_RETURN_CODE 77)
    endforeach()
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/has_avx2.cpp
    "int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }\n")
  try_run(has_avx2 has_avx2_compiled ${PROJECT_BINARY_DIR}/has_avx2 ${PROJECT_BINARY_DIR}/has_avx2.cpp)
  if(NOT has_avx2_compiled OR NOT has_avx2 EQUAL 0)
    message(STATUS "The processor has no AVX2: no test of an application compiled for it")
    set_tests_properties(consumer.flags_avx2 PROPERTIES DISABLED ON)
  endif()
endif()
# The one consumer of tests/run --change: the package as this build installs it.
if(TETSKIN_INSTALL)
  set(own_prefix ${PROJECT_BINARY_DIR}/consumers/own_prefix)
  add_test(NAME consumer.no_install COMMAND ${CMAKE_COMMAND} -E rm -rf ${own_prefix})
  add_test(NAME consumer.own_install COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${own_prefix})
  set_tests_properties(consumer.no_install consumer.own_install PROPERTIES FIXTURES_SETUP own_install LABELS "config;change")
  set_tests_properties(consumer.own_install PROPERTIES DEPENDS consumer.no_install)
  tetskin_test_consumer(own_package -DCMAKE_PREFIX_PATH=${own_prefix} -DCONSUME=package)
  set_tests_properties(consumer.own_package PROPERTIES FIXTURES_REQUIRED own_install LABELS "config;change")
endif()
# Shared libraries: their names, their exported symbols, and that a program runs with them.
add_test(NAME consumer.shared
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DFOLDER=${PROJECT_BINARY_DIR}/consumers/shared
    -DGENERATOR=${CMAKE_GENERATOR} -DVERSION=${PROJECT_VERSION} -DNM=${NM}
    -DPKG_CONFIG=${PKG_CONFIG} -DCOMPILER=${CMAKE_CXX_COMPILER}
    -P ${CMAKE_CURRENT_SOURCE_DIR}/consumer/shared.cmake)
add_test(NAME consumer.after_demos_run
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DFOLDER=${PROJECT_BINARY_DIR}/consumers/after_demos_run
    -DGENERATOR=${CMAKE_GENERATOR} -P ${CMAKE_CURRENT_SOURCE_DIR}/consumer/after_demos_run.cmake)
set_tests_properties(consumer.shared consumer.after_demos_run
  PROPERTIES TIMEOUT 1200 PROCESSORS ${nested_parallel} LABELS "${labels_full}")
# What this build has compiled of the same text, joined in the same way, is not compiled again.
set(same_objects)
if(PYTHON_IN_PATH AND CMAKE_EXPORT_COMPILE_COMMANDS)
  set(same_objects -DOBJECTS_OF=${PROJECT_BINARY_DIR})
  if(DEFINED CACHE{CMAKE_UNITY_BUILD_BATCH_SIZE})
    list(APPEND same_objects -DCMAKE_UNITY_BUILD_BATCH_SIZE=$CACHE{CMAKE_UNITY_BUILD_BATCH_SIZE})
  endif()
endif()
tetskin_test_consumer(add_subdirectory -DCONSUME=subdirectory -DCMAKE_UNITY_BUILD=ON ${same_objects})

# Configurations that must stop with a message that gives the reason.
function(tetskin_test_refusal name message)
  add_test(NAME refusal.${name}
    COMMAND ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} -B ${PROJECT_BINARY_DIR}/refusals/${name}
      -DTETSKIN_TESTS=OFF -DTETSKIN_DEMOS=OFF -DTETSKIN_IO=OFF ${ARGN})
  string(REPLACE " " "[^A-Za-z]+" pattern "${message}")  # CMake wraps the lines of its messages
  set_tests_properties(refusal.${name} PROPERTIES PASS_REGULAR_EXPRESSION "${pattern}" LABELS config)
endfunction()

# Bullet configurations as they may occur on a user's machine: with the other precision, and without stating it.
function(tetskin_fake_bullet name definitions suffix)
  file(WRITE ${PROJECT_BINARY_DIR}/fake_bullet/${name}/BulletConfig.cmake
    "set(BULLET_DEFINITIONS \"${definitions}\")\n"
    "set(BULLET_INCLUDE_DIRS \"${bullet_includes}\")\n"
    "set(BULLET_LIBRARIES LinearMath${suffix} BulletCollision${suffix} BulletDynamics${suffix} BulletSoftBody${suffix})\n"
    "set(BULLET_LIBRARY_DIRS \"${bullet_folder}\")\nset(BULLET_ROOT_DIR /)\n")
endfunction()
if(TARGET tetskin::bullet_physics AND NOT TARGET BulletSoftBody AND NOT TARGET Bullet::Bullet)
  get_target_property(bullet_includes tetskin::bullet_physics INTERFACE_INCLUDE_DIRECTORIES)
  get_target_property(bullet_libraries tetskin::bullet_physics INTERFACE_LINK_LIBRARIES)
  list(GET bullet_libraries 0 bullet_library)
  cmake_path(GET bullet_library PARENT_PATH bullet_folder)
  tetskin_fake_bullet(float "" "")
  tetskin_fake_bullet(double "-DBT_USE_DOUBLE_PRECISION" "-float64")
  tetskin_fake_bullet(lying "" "-float64")
  tetskin_test_refusal(double_wanted_but_float_found "PRECISION is ON but the Bullet found"
    -DTETSKIN_DOUBLE_PRECISION=ON -DBullet_DIR=${PROJECT_BINARY_DIR}/fake_bullet/float)
  tetskin_test_refusal(float_wanted_but_double_found "is built in double precision but TETSKIN"
    -DBullet_DIR=${PROJECT_BINARY_DIR}/fake_bullet/double)
  tetskin_test_refusal(library_of_the_other_precision "does not link in the precision asked for"
    -DBullet_DIR=${PROJECT_BINARY_DIR}/fake_bullet/lying)
endif()
tetskin_test_refusal(demos_without_their_parts "The demos need every part" -DTETSKIN_DEMOS=ON)
tetskin_test_refusal(tests_of_shared_libraries "tests need static libraries" -DBUILD_SHARED_LIBS=ON -DTETSKIN_TESTS=ON)

# Style.
#   first argument after the name, if it is `full` or `change`: a label, besides `style`
function(tetskin_test_style name)
  set(labels style)
  if(ARGV1 MATCHES "^(full|change)$")
    list(POP_FRONT ARGN label)
    list(APPEND labels ${label})
  endif()
  add_test(NAME style.${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(style.${name} PROPERTIES LABELS "${labels}" TIMEOUT 1800)
endfunction()
if(PYTHON_OF_SYSTEM)
  tetskin_test_style(comments ${PYTHON_OF_SYSTEM} -B tests/style/comments.py)
  tetskin_test_style(tiers ${PYTHON_OF_SYSTEM} -B tests/tiers/test_tiers.py)
  tetskin_test_style(drawing ${PYTHON_OF_SYSTEM} -B tests/style/drawing.py)
  tetskin_test_style(options ${PYTHON_OF_SYSTEM} -B tests/style/options.py)
  tetskin_test_style(pages ${PYTHON_OF_SYSTEM} -B tests/style/pages.py)
  tetskin_test_style(lines ${PYTHON_OF_SYSTEM} -B tests/style/lines.py)
  set_tests_properties(style.lines PROPERTIES SKIP_RETURN_CODE 77)  # without git
  tetskin_test_style(moving ${PYTHON_OF_SYSTEM} -B tests/style/moving.py)
endif()
if(python_with_matplotlib)
  tetskin_test_style(links ${python_with_matplotlib} -B tests/style/links.py)
  tetskin_test_style(figures ${python_with_matplotlib} -B tests/style/figures.py)
endif()
tetskin_test_style(layers ${CMAKE_COMMAND} -P tests/style/layers.cmake)
tetskin_test_style(portable ${CMAKE_COMMAND} -P tests/style/portable.cmake)
tetskin_test_style(workflow tests/platforms/workflow)
set_tests_properties(style.workflow PROPERTIES SKIP_RETURN_CODE 77)  # without npm, or without a registry for it
if(TARGET docs)
  tetskin_test_style(docs ${DOXYGEN_EXECUTABLE} ${PROJECT_BINARY_DIR}/plugin/Doxyfile.docs)
endif()
# Use the compile commands of a configuration without unity builds, which is made here and not built.
set(alone ${PROJECT_BINARY_DIR}/configurations/alone)
if(PYTHON_OF_SYSTEM AND CMAKE_GENERATOR MATCHES "Ninja|Makefiles")
  tetskin_test_style(alone_configured ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} -B ${alone} -G ${CMAKE_GENERATOR}
    -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=OFF
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DTETSKIN_TESTS=OFF -DTETSKIN_DEMOS=OFF)
  set_tests_properties(style.alone_configured PROPERTIES FIXTURES_SETUP compile_commands)
  set(alone_check ${PYTHON_OF_SYSTEM} -B tests/style/alone.py ${alone})
  if(CLANG_CXX)
    list(APPEND alone_check --compiler ${CLANG_CXX})
  endif()
  tetskin_test_style(alone full ${alone_check})
  tetskin_test_style(alone_changes change ${alone_check} --files ${changes}/sources)
  set_tests_properties(style.alone style.alone_changes PROPERTIES FIXTURES_REQUIRED compile_commands
    PROCESSORS ${nested_parallel})
  if(CLANG_TIDY AND CMAKE_EXPORT_COMPILE_COMMANDS)
    set(tidy_check ${PYTHON_OF_SYSTEM} -B tests/style/tidy.py ${CLANG_TIDY} ${PROJECT_BINARY_DIR} ${alone})
    tetskin_test_style(tidy full ${tidy_check})
    tetskin_test_style(tidy_changes change ${tidy_check} --files ${changes}/sources)
    set_tests_properties(style.tidy style.tidy_changes PROPERTIES FIXTURES_REQUIRED compile_commands
      PROCESSORS ${nested_parallel})
  endif()
endif()
if(CLANG_FORMAT)
  tetskin_test_style(format ${CMAKE_CURRENT_SOURCE_DIR}/style/format ${CLANG_FORMAT})
endif()
