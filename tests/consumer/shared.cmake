# cmake -DSOURCE= -DFOLDER= -DGENERATOR= -DVERSION= -DNM= -DPKG_CONFIG= -DCOMPILER= -P: all libraries shared, installed, and used by the README's
# first program; their names contain the ABI, and private names are hidden.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
set(prefix ${FOLDER}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON
  "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG" -DCMAKE_UNITY_BUILD=ON -DTETSKIN_WARNINGS_AS_ERRORS=ON
  -DCMAKE_INSTALL_LIBDIR=lib/here)
run(${CMAKE_COMMAND} --build ${FOLDER}/build --parallel 2)
run(${CMAKE_COMMAND} --install ${FOLDER}/build --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${FOLDER}/consumer -G ${GENERATOR} -Dtetskin_DIR=${prefix}/lib/here/cmake/tetskin
  -DCMAKE_BUILD_TYPE=Release -DCONSUME=program -DSOURCE=${SOURCE})
run(${CMAKE_COMMAND} --build ${FOLDER}/consumer)
run(${CMAKE_CTEST_COMMAND} --test-dir ${FOLDER}/consumer --output-on-failure --no-tests=error)

# The program is also built without CMake, wherever the libraries are installed.
if(PKG_CONFIG)
  run(${CMAKE_COMMAND} -DSOURCE=${SOURCE} -DPREFIX=${prefix} -DCOMPILER=${COMPILER} -DPKG_CONFIG=${PKG_CONFIG}
    -DFOLDER=${FOLDER}/pkg_config -P ${SOURCE}/tests/consumer/pkg_config.cmake)
endif()

string(REGEX MATCH "^[0-9]+[.][0-9]+" abi ${VERSION})  # while the major version is 0
foreach(library core bullet cage contact elastic io reduced replay solver threads touch world)
  file(GLOB_RECURSE so ${prefix}/libtetskin_${library}.so.${abi})
  if(NOT so)
    message(FATAL_ERROR "No library tetskin_${library} with the ABI ${abi} in its name")
  endif()
  if(NOT NM)
    continue()
  endif()
  execute_process(COMMAND ${NM} -D -C --defined-only ${so} OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
  # Symbols of functions, tables and classes; those of templates begin with their result type.
  set(shown " [TWVDRBu] ([a-z ]+ for )?([A-Za-z:]+ )?tetskin::")
  # Bodies in Bullet's worlds are stepped by these.
  if(library STREQUAL elastic)
    string(REGEX REPLACE "[^\n]*elastic_detail::(BlockMatrix|BodyDynamics|ConjugateGradient|CorotatedTets|MaterialChanges|PressureSurface|restTets|restQuadraticTets|findRestNodes|takeRestShapes)[^\n]*" ""
      names "${names}")
  endif()
  # A class that solver derives from: its type information is repeated there; and one that it copies.
  if(library STREQUAL solver)
    string(REGEX REPLACE "[^\n]*elastic_detail::MaterialChanges::Group[*] std::[^\n]*" "" names "${names}")
    string(REGEX REPLACE "[^\n]* (vtable|typeinfo|typeinfo name) for tetskin::elastic_detail::ConjugateGradient<(float|double)>::CouplingOperator" ""
      names "${names}")
  endif()
  if(names MATCHES "${shown}(findTets|skinPoints|(io|cage_detail|elastic_detail|kernels)::|bullet_detail::(BodyContacts|ContactRows|SchurComplement))[^\n]*")
    message(FATAL_ERROR "${so} shows ${CMAKE_MATCH_0}")
  endif()
  if(NOT names MATCHES "${shown}(embed|createSoftBody|createCage|calibrate|loadMesh|ThreadPool|SurfaceContact|ReducedBody|SurfaceTree|World|DeformableWorld|saveSnapshot)")
    message(FATAL_ERROR "${so} does not show what is public")
  endif()
endforeach()
