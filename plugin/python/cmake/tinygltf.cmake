# tinygltf from its header alone, without what reads images.
#   TINYGLTF_INCLUDE, JSON_INCLUDE  the folders of tiny_gltf.h and of nlohmann
file(WRITE "${CMAKE_BINARY_DIR}/tinygltf.cpp" "#define TINYGLTF_IMPLEMENTATION\n#include <tiny_gltf.h>\n")
add_library(tinygltf STATIC EXCLUDE_FROM_ALL "${CMAKE_BINARY_DIR}/tinygltf.cpp")
target_include_directories(tinygltf SYSTEM PUBLIC "${TINYGLTF_INCLUDE}" "${JSON_INCLUDE}")
target_compile_definitions(tinygltf PUBLIC TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE
  TINYGLTF_NO_EXTERNAL_IMAGE TINYGLTF_NO_INCLUDE_STB_IMAGE TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE)
set_target_properties(tinygltf PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
  VISIBILITY_INLINES_HIDDEN ON)
add_library(TinyGLTF::TinyGLTF ALIAS tinygltf)
