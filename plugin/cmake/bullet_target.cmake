# Bullet's CMake package sets only variables: a relative include path, libraries in the wrong order for static linking,
# and the precision as a compiler flag. tetskin_find_bullet() makes one proper target of them, tetskin::bullet_physics,
# for the precision that TETSKIN_DOUBLE_PRECISION requests.

function(_tetskin_check_bullet_precision)
  get_directory_property(definitions COMPILE_DEFINITIONS)
  if("BT_USE_DOUBLE_PRECISION" IN_LIST definitions AND NOT TETSKIN_DOUBLE_PRECISION)
    message(FATAL_ERROR "tetskin is set to Bullet in float, but this project compiles with BT_USE_DOUBLE_PRECISION. "
      "Set TETSKIN_DOUBLE_PRECISION=ON, or remove that definition.")
  endif()

  # The mangled name of btSoftBody::setTotalMass contains the type of btScalar, so a library with the other precision
  # does not link. Otherwise the error would only be noticed when memory is corrupted.
  set(probe "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/tetskin_bullet_probe.cpp")
  file(WRITE "${probe}" "#include <BulletSoftBody/btSoftBody.h>\n"
    "void (btSoftBody::*volatile probe)(btScalar, bool) = &btSoftBody::setTotalMass;\n"
    "int main() { return probe == nullptr; }\n")
  try_compile(tetskin_bullet_matches "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/tetskin_bullet_probe" SOURCES "${probe}"
    LINK_LIBRARIES tetskin::bullet_physics OUTPUT_VARIABLE log)
  if(NOT tetskin_bullet_matches)
    if(TETSKIN_DOUBLE_PRECISION)
      set(cure "TETSKIN_DOUBLE_PRECISION is ON: install Bullet built with BT_USE_DOUBLE_PRECISION (Debian's "
        "libbullet-dev has it as BulletConfig-float64.cmake), point Bullet_DIR at it, or set the option to OFF.")
    else()
      set(cure "TETSKIN_DOUBLE_PRECISION is OFF: point Bullet_DIR at a Bullet built in float, or set the option to ON.")
    endif()
    list(JOIN cure "" cure)
    message(FATAL_ERROR "The Bullet found in ${Bullet_DIR} does not link in the precision asked for. ${cure}\n${log}")
  endif()
endfunction()

function(tetskin_find_bullet)
  if(TARGET tetskin::bullet_physics)
    return()
  endif()
  # Debian has both precisions side by side; a Bullet built from source has one configuration, which states its
  # precision.
  set(configs BulletConfig.cmake)
  if(TETSKIN_DOUBLE_PRECISION)
    list(PREPEND configs BulletConfig-float64.cmake)
  endif()
  find_package(Bullet CONFIG QUIET CONFIGS ${configs})
  if(NOT Bullet_FOUND)
    message(FATAL_ERROR "Bullet was not found. Install it (Debian, Ubuntu: libbullet-dev), set Bullet_DIR to the folder "
      "of its BulletConfig.cmake, or build without it: TETSKIN_BULLET=OFF.")
  endif()

  set(is_double OFF)
  if("${BULLET_DEFINITIONS}" MATCHES "BT_USE_DOUBLE_PRECISION")
    set(is_double ON)
  endif()
  if(is_double AND NOT TETSKIN_DOUBLE_PRECISION)
    message(FATAL_ERROR "The Bullet found in ${Bullet_DIR} is built in double precision, but TETSKIN_DOUBLE_PRECISION "
      "is OFF. Set it to ON, or point Bullet_DIR at a Bullet built in float.")
  elseif(TETSKIN_DOUBLE_PRECISION AND NOT is_double)
    message(FATAL_ERROR "TETSKIN_DOUBLE_PRECISION is ON, but the Bullet found in ${Bullet_DIR} is built in float. "
      "Set it to OFF, or point Bullet_DIR at a Bullet built with BT_USE_DOUBLE_PRECISION.")
  endif()

  set(root "${BULLET_ROOT_DIR}")
  set(includes)
  foreach(folder ${BULLET_INCLUDE_DIRS})
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${root}")
    list(APPEND includes "${folder}")
  endforeach()
  set(folders)
  foreach(folder ${BULLET_LIBRARY_DIRS})
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${root}")
    list(APPEND folders "${folder}")
  endforeach()

  set(libraries)
  foreach(part BulletSoftBody BulletDynamics BulletCollision LinearMath)  # dependent before dependency
    set(names ${BULLET_LIBRARIES})
    list(FILTER names INCLUDE REGEX "^${part}(-.*)?$")
    unset(library)
    find_library(library NAMES ${names} PATHS ${folders} NO_DEFAULT_PATH NO_CACHE)
    if(NOT library)
      message(FATAL_ERROR "Bullet's configuration in ${Bullet_DIR} promises the library ${part} (${names}) in "
        "${folders}, but it is not there. Reinstall Bullet.")
    endif()
    list(APPEND libraries "${library}")
  endforeach()

  add_library(tetskin::bullet_physics INTERFACE IMPORTED GLOBAL)
  set_target_properties(tetskin::bullet_physics PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${includes}"  # of an imported target, and therefore system headers
    INTERFACE_LINK_LIBRARIES "${libraries}")
  if(TETSKIN_DOUBLE_PRECISION)
    set_target_properties(tetskin::bullet_physics PROPERTIES INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION)
  endif()
  _tetskin_check_bullet_precision()
endfunction()
