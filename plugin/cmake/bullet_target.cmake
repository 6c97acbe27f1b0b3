# tetskin::bullet_physics is all that tetskin knows about Bullet: its headers, its libraries, and its compile
# definitions. A project that defines this target before it adds or finds tetskin says by it which Bullet is used.
# Otherwise tetskin_find_bullet() makes it
#   1. of targets in the same build: BulletSoftBody and those that it needs (Bullet as a subproject), or Bullet::Bullet;
#   2. of the targets of an installed package, by the same names (vcpkg, Conan);
#   3. of the variables that Bullet's own package sets: a relative include path, libraries in the wrong order for static
#      linking, and the precision as a compiler flag.
# TETSKIN_DOUBLE_PRECISION says which precision is wanted; another one stops the configuration.
set(_tetskin_bullet_parts BulletSoftBody BulletDynamics BulletCollision LinearMath)  # dependent before dependency

# definitions  of the Bullet that was found
# what         where it is, for the message
function(_tetskin_require_precision definitions what)
  set(is_double OFF)
  if("BT_USE_DOUBLE_PRECISION" IN_LIST definitions)
    set(is_double ON)
  endif()
  if(is_double AND NOT TETSKIN_DOUBLE_PRECISION)
    message(FATAL_ERROR "The Bullet found in ${what} is built in double precision, but TETSKIN_DOUBLE_PRECISION "
      "is OFF. Set it to ON, or point Bullet_DIR at a Bullet built in float.")
  elseif(TETSKIN_DOUBLE_PRECISION AND NOT is_double)
    message(FATAL_ERROR "TETSKIN_DOUBLE_PRECISION is ON, but the Bullet found in ${what} is built in float. "
      "Set it to OFF, or point Bullet_DIR at a Bullet built with BT_USE_DOUBLE_PRECISION.")
  endif()
endfunction()

# The mangled name of btSoftBody::setTotalMass contains the type of btScalar, so a library with the other precision does
# not link. Otherwise the error would only be noticed when memory is corrupted.
function(_tetskin_check_bullet_links what)
  set(probe "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/tetskin_bullet_probe.cpp")
  file(WRITE "${probe}" "#include <BulletSoftBody/btSoftBody.h>\n"
    "void (btSoftBody::*volatile probe)(btScalar, bool) = &btSoftBody::setTotalMass;\n"
    "int main() { return probe == nullptr; }\n")
  # A package's properties may depend on the configuration (Conan).
  set(configurations ${CMAKE_BUILD_TYPE} ${CMAKE_CONFIGURATION_TYPES})
  if(NOT CMAKE_TRY_COMPILE_CONFIGURATION AND configurations)
    list(GET configurations 0 CMAKE_TRY_COMPILE_CONFIGURATION)
  endif()
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
    message(FATAL_ERROR "The Bullet found in ${what} does not link in the precision asked for. ${cure}\n${log}")
  endif()
endfunction()

# The definitions by which Bullet's headers declare other things, as stated by its package, its targets and, for those
# of the same build, their folders.
function(_tetskin_bullet_definitions result)
  set(stated ${BULLET_DEFINITIONS})
  foreach(target ${ARGN})
    get_target_property(imported ${target} IMPORTED)
    set(properties INTERFACE_COMPILE_DEFINITIONS INTERFACE_COMPILE_OPTIONS)
    if(NOT imported)
      list(APPEND properties COMPILE_DEFINITIONS COMPILE_OPTIONS)
      get_target_property(folder ${target} SOURCE_DIR)
      get_directory_property(of_folder DIRECTORY "${folder}" COMPILE_DEFINITIONS)
      list(APPEND stated ${of_folder})
    endif()
    foreach(property ${properties})
      get_target_property(of_target ${target} ${property})
      if(of_target)
        list(APPEND stated ${of_target})
      endif()
    endforeach()
  endforeach()
  set(definitions)
  if("${stated}" MATCHES "BT_USE_DOUBLE_PRECISION")  # perhaps within a generator expression
    list(APPEND definitions BT_USE_DOUBLE_PRECISION)
  endif()
  if("${stated}" MATCHES "BT_THREADSAFE(=1)?([^=A-Z_]|$)")
    list(APPEND definitions BT_THREADSAFE=1)
  endif()
  set(${result} ${definitions} PARENT_SCOPE)
endfunction()

# Of an imported target, and therefore system headers.
function(_tetskin_make_bullet_target includes libraries definitions)
  add_library(tetskin::bullet_physics INTERFACE IMPORTED GLOBAL)
  set_target_properties(tetskin::bullet_physics PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${includes}"
    INTERFACE_LINK_LIBRARIES "${libraries}" INTERFACE_COMPILE_DEFINITIONS "${definitions}")
endfunction()

# The names of Bullet's targets, if they exist.
function(_tetskin_bullet_targets result)
  set(targets)
  if(TARGET BulletSoftBody)
    set(targets ${_tetskin_bullet_parts})
  elseif(TARGET Bullet::Bullet)
    set(targets Bullet::Bullet)
  endif()
  foreach(target ${targets})
    if(NOT TARGET ${target})
      message(FATAL_ERROR "There is a target BulletSoftBody, but none of the name ${target}: tetskin::bullet needs "
        "${_tetskin_bullet_parts}. Add Bullet's folder before tetskin's, or define tetskin::bullet_physics.")
    endif()
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

function(_tetskin_bullet_of_targets)
  set(includes)
  set(built_here OFF)
  foreach(target ${ARGN})
    get_target_property(imported ${target} IMPORTED)
    if(NOT imported)
      set(built_here ON)
      get_target_property(folder ${target} SOURCE_DIR)
      cmake_path(GET folder PARENT_PATH folder)
      list(APPEND includes "${folder}")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES includes)
  list(JOIN ARGN ", " what)
  set(what "the targets ${what}")
  _tetskin_bullet_definitions(definitions ${ARGN})
  # A Bullet built here states its precision, and cannot be linked yet. An installed package may leave it unsaid, but
  # links.
  if(built_here OR "BT_USE_DOUBLE_PRECISION" IN_LIST definitions)
    _tetskin_require_precision("${definitions}" "${what}")
  endif()
  if(TETSKIN_DOUBLE_PRECISION)
    list(APPEND definitions BT_USE_DOUBLE_PRECISION)
    list(REMOVE_DUPLICATES definitions)
  endif()
  _tetskin_make_bullet_target("${includes}" "${ARGN}" "${definitions}")
  if(NOT built_here)  # otherwise there is nothing to link yet
    _tetskin_check_bullet_links("${what}")
  endif()
endfunction()

# Absolute paths of folders that Bullet's package states relative to its root.
function(_tetskin_absolute result)
  set(absolute)
  foreach(folder ${ARGN})
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${BULLET_ROOT_DIR}")
    list(APPEND absolute "${folder}")
  endforeach()
  set(${result} ${absolute} PARENT_SCOPE)
endfunction()

# The path of one of Bullet's libraries. On Windows, each configuration has its own library name.
function(_tetskin_bullet_library result part config_folder)
  set(names ${BULLET_LIBRARIES})
  list(FILTER names INCLUDE REGEX "^${part}(-.*)?$")
  list(TRANSFORM names APPEND _Debug OUTPUT_VARIABLE debug_names)
  list(TRANSFORM names APPEND _RelWithDebugInfo OUTPUT_VARIABLE information_names)
  list(TRANSFORM names APPEND _MinsizeRel OUTPUT_VARIABLE small_names)
  # The folders are absolute: do not search in a cross compiler's root.
  set(places PATHS ${ARGN} NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE)
  find_library(release NAMES ${names} ${information_names} ${small_names} ${places})
  find_library(debug NAMES ${debug_names} ${places})
  if(release AND debug)
    set(${result} "$<IF:$<CONFIG:Debug>,${debug},${release}>" PARENT_SCOPE)
  elseif(release)
    set(${result} "${release}" PARENT_SCOPE)
  elseif(debug)
    set(${result} "${debug}" PARENT_SCOPE)
  else()
    message(FATAL_ERROR "Bullet's configuration in ${config_folder} promises the library ${part} (${names}) in "
      "${ARGN}, but it is not there. Reinstall Bullet; from its sources, with -DINSTALL_LIBS=ON, which is off by "
      "default where a build has several configurations.")
  endif()
endfunction()

function(_tetskin_bullet_of_variables config_folder)
  _tetskin_bullet_definitions(definitions)
  _tetskin_require_precision("${definitions}" "${config_folder}")
  # A package is where its configuration is, whatever prefix it was built for.
  cmake_path(SET beside NORMALIZE "${config_folder}/../..")
  _tetskin_absolute(folders ${BULLET_LIBRARY_DIRS})
  _tetskin_absolute(includes ${BULLET_INCLUDE_DIRS})
  set(libraries)
  foreach(part ${_tetskin_bullet_parts})
    _tetskin_bullet_library(library ${part} "${config_folder}" "${beside}" ${folders})
    list(APPEND libraries "${library}")
  endforeach()
  _tetskin_make_bullet_target("${includes}" "${libraries}" "${definitions}")
  _tetskin_check_bullet_links("${config_folder}")
endfunction()

# Finds Bullet's package. In double, Debian has a second configuration beside that in float; Homebrew has one in a folder
# below the libraries in float. A macro: the package sets variables.
macro(_tetskin_find_bullet_package)
  set(configs BulletConfig.cmake)
  if(TETSKIN_DOUBLE_PRECISION)
    list(PREPEND configs BulletConfig-float64.cmake)
  endif()
  set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # tetskin::bullet_physics is known everywhere
  find_package(Bullet CONFIG QUIET CONFIGS ${configs})
  if(NOT Bullet_FOUND)
    message(FATAL_ERROR "Bullet was not found. Install it (Debian, Ubuntu: libbullet-dev), set Bullet_DIR to the folder "
      "of its BulletConfig.cmake, or build without it: TETSKIN_BULLET=OFF.")
  endif()
  set(config_folder "${Bullet_DIR}")
  set(double "${Bullet_DIR}/../../bullet/double/cmake/bullet")
  if(TETSKIN_DOUBLE_PRECISION AND NOT "${BULLET_DEFINITIONS}" MATCHES "DOUBLE" AND EXISTS "${double}/BulletConfig.cmake")
    cmake_path(SET config_folder NORMALIZE "${double}")
    include("${config_folder}/BulletConfig.cmake")
  endif()
endmacro()

function(tetskin_find_bullet)
  if(TARGET tetskin::bullet_physics)
    return()
  endif()
  get_directory_property(of_project COMPILE_DEFINITIONS)
  if("BT_USE_DOUBLE_PRECISION" IN_LIST of_project AND NOT TETSKIN_DOUBLE_PRECISION)
    message(FATAL_ERROR "tetskin is set to Bullet in float, but this project compiles with BT_USE_DOUBLE_PRECISION. "
      "Set TETSKIN_DOUBLE_PRECISION=ON, or remove that definition.")
  endif()
  _tetskin_bullet_targets(targets)
  if(NOT targets)
    _tetskin_find_bullet_package()
    _tetskin_bullet_targets(targets)
  endif()
  if(targets)
    _tetskin_bullet_of_targets(${targets})
  else()
    _tetskin_bullet_of_variables("${config_folder}")
  endif()
endfunction()
