# cmake -DSOURCE= -DPREFIX= -DFOLDER= -DCOMPILER= -DPKG_CONFIG= -P: demos/examples/hello.cpp, and the umbrella header,
# built with what tetskin.pc says, without CMake.
file(GLOB_RECURSE pc ${PREFIX}/tetskin.pc)
cmake_path(GET pc PARENT_PATH pc_folder)
set(ENV{PKG_CONFIG_PATH} ${pc_folder})
set(ENV{LD_LIBRARY_PATH} ${pc_folder}/..)  # needed with shared libraries
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs tetskin OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY
  OUTPUT_STRIP_TRAILING_WHITESPACE)
separate_arguments(flags UNIX_COMMAND "${flags}")
file(MAKE_DIRECTORY ${FOLDER})
file(WRITE ${FOLDER}/umbrella.cpp "#include <tetskin/tetskin.h>\n#include <cstdio>\n"
  "int main() {\n"
  "  tetskin::TriangleMesh mesh;\n"
  "  const auto cage = tetskin::createCage(mesh);\n"
  "  tetskin::Cage body;\n"
  "  const auto calibrated = tetskin::calibrate(body);\n"
  "  const tetskin::ThreadPool pool;\n"
  "  const auto loaded = tetskin::loadMesh(\"none.obj\");\n"
  "  tetskin::SoftBodySkin skin;\n"
  "  const bool bound = skin.update() != tetskin::StatusCode::Unbound;\n"
  "  std::puts(TETSKIN_VERSION);\n"
  "  return cage.ok() || calibrated.ok() || loaded.ok() || bound;\n}\n")
foreach(source ${SOURCE}/demos/examples/hello.cpp ${FOLDER}/umbrella.cpp)
  execute_process(COMMAND ${COMPILER} -std=c++17 -O1 ${source} -o ${FOLDER}/program ${flags}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${FOLDER}/program COMMAND_ERROR_IS_FATAL ANY)
endforeach()
