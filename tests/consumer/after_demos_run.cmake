# cmake -DSOURCE= -DFOLDER= -DGENERATOR= -P: tests that the build of demos/run --all can be installed, and that the
# package is found. Nothing is compiled: see no_compiler.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(READ ${SOURCE}/demos/run demos_run)
if(NOT demos_run MATCHES
    "configure \"\\$repository\" ([^\n]+)\nif [^\n]+--all[^\n]+\n  cmake --build \"\\$repository/build\" --target ([a-z]+) ")
  message(FATAL_ERROR "demos/run no longer says what it configures and builds: follow it here")
endif()
separate_arguments(options UNIX_COMMAND "${CMAKE_MATCH_1}")
set(target ${CMAKE_MATCH_2})
set(no_compiler ${SOURCE}/tests/consumer/no_compiler)

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release ${options}
  -DCMAKE_CXX_COMPILER_LAUNCHER=${no_compiler} -DCMAKE_CXX_LINKER_LAUNCHER=${no_compiler})
run(${CMAKE_COMMAND} --build ${FOLDER}/build --target ${target})
run(${CMAKE_COMMAND} --install ${FOLDER}/build --prefix ${FOLDER}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${FOLDER}/consumer -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${FOLDER}/prefix -DCONSUME=package -DSOURCE=${SOURCE})
