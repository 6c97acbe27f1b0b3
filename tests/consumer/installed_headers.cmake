# cmake -DSOURCE= -DPREFIX= -DSTAGED= -DCOMPILER= -DEIGEN= -P: tests that exactly the public headers are installed, at
# most 31; a file that includes a private one compiles neither with the installation nor in the build.
file(GLOB_RECURSE installed RELATIVE ${PREFIX}/include ${PREFIX}/include/*)
file(GLOB public RELATIVE ${SOURCE}/plugin ${SOURCE}/plugin/tetskin/*.h ${SOURCE}/plugin/tetskin/*/*.h)
list(SORT installed)
list(SORT public)
if(NOT installed STREQUAL public)
  message(FATAL_ERROR "Installed: ${installed}\nPublic: ${public}")
endif()
list(LENGTH installed count)
if(count GREATER 31)
  message(FATAL_ERROR "${count} public headers are more than 31")
endif()

file(GLOB_RECURSE private RELATIVE ${SOURCE}/plugin ${SOURCE}/plugin/tetskin/*.h)
list(FILTER private INCLUDE REGEX "/src/")
list(LENGTH private count)
if(count LESS 50)
  message(FATAL_ERROR "Only ${count} private headers found: look for them elsewhere")
endif()
# The compiler decides: a header that is found, but does not compile because another one is missing, would be no better.
set(file ${PREFIX}/../finds_headers.cpp)
foreach(folder ${PREFIX}/include ${STAGED})
  set(text "#if !__has_include(<tetskin/tetskin.h>)\n#error nothing is found\n#endif\n")
  foreach(header ${private})
    string(APPEND text "#if __has_include(<${header}>)\n#error private: ${header}\n#endif\n")
  endforeach()
  # Each public header also compiles alone, if it needs no Bullet.
  file(WRITE ${file} "${text}")
  execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -I${folder} -isystem ${EIGEN} ${file}
    COMMAND_ERROR_IS_FATAL ANY)
  foreach(header ${public})
    if(header MATCHES "/(bullet|solver|replay|contact|touch|reduced|world)/")
      continue()
    endif()
    file(WRITE ${file} "#include <${header}>\n")
    execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -I${folder} -isystem ${EIGEN} ${file}
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endforeach()

# Checks that including the first private header is indeed an error.
list(GET private 0 header)
file(WRITE ${file} "#include <${header}>\n")
execute_process(COMMAND ${COMPILER} -std=c++17 -fsyntax-only -I${PREFIX}/include -isystem ${EIGEN} ${file}
  RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
if(NOT failed)
  message(FATAL_ERROR "A file that includes ${header} compiles")
endif()
