# Bullet for the wheel, from its sources: in float, static, position-independent, and seen by nothing outside.
#   BULLET_SOURCE  a variable of CMake or of the environment: the folder of Bullet's sources. Empty: the folder
#                  `bullet`, which a staged source package has, or else what fetch_bullet fetches, in a checkout
set(BULLET_SOURCE "$ENV{BULLET_SOURCE}" CACHE PATH "Folder of the sources of Bullet 3.24; empty: they are fetched")
set(bullet "${BULLET_SOURCE}")
set(cure "Set BULLET_SOURCE, in the environment, to a folder of the sources of Bullet 3.24 (of its release on GitHub, "
  "or of the source package `bullet` of Debian 12 or Ubuntu 24.04).")
list(JOIN cure "" cure)
if(NOT bullet AND EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/bullet/VERSION")
  set(bullet "${CMAKE_CURRENT_SOURCE_DIR}/bullet")
endif()
if(NOT bullet)
  execute_process(COMMAND bash "${CMAKE_CURRENT_SOURCE_DIR}/fetch_bullet" RESULT_VARIABLE failed OUTPUT_VARIABLE bullet
    ERROR_VARIABLE why OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_STRIP_TRAILING_WHITESPACE)
  if(NOT failed EQUAL 0)
    message(FATAL_ERROR "The sources of Bullet could not be fetched: ${why}\n${cure}")
  endif()
endif()
if(NOT EXISTS "${bullet}/src/BulletSoftBody/btSoftBody.cpp" OR NOT EXISTS "${bullet}/VERSION")
  message(FATAL_ERROR "There are no sources of Bullet in ${bullet}. ${cure}")
endif()
file(STRINGS "${bullet}/VERSION" bullet_version LIMIT_COUNT 1)
if(NOT bullet_version STREQUAL "3.24")
  message(FATAL_ERROR "The wheel is made with Bullet 3.24, but ${bullet} has ${bullet_version}. ${cure}")
endif()

foreach(part LinearMath BulletCollision BulletDynamics BulletSoftBody)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${bullet}/src/${part}/*.cpp")
  add_library(${part} STATIC EXCLUDE_FROM_ALL ${sources})
  target_include_directories(${part} SYSTEM PUBLIC "${bullet}/src")
  target_compile_options(${part} PRIVATE -w -ffp-contract=off)
  set_target_properties(${part} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON UNITY_BUILD OFF)
endforeach()
add_library(tetskin::bullet_physics INTERFACE IMPORTED GLOBAL)
target_link_libraries(tetskin::bullet_physics INTERFACE BulletSoftBody BulletDynamics BulletCollision LinearMath)
target_include_directories(tetskin::bullet_physics SYSTEM INTERFACE "${bullet}/src")
