# Bullet for the wheel and for the JavaScript module, from its sources: in float, static, position-independent, and with
# hidden symbols.
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
  execute_process(COMMAND bash "${CMAKE_CURRENT_LIST_DIR}/../fetch_bullet" RESULT_VARIABLE failed OUTPUT_VARIABLE bullet
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
  message(FATAL_ERROR "The package is made with Bullet 3.24, but ${bullet} has ${bullet_version}. ${cure}")
endif()

# Leaves out a third of the sources, which neither the library nor the binding uses. If something is missing after all,
# the build fails at the stub, which is made by importing the module.
set(unused
  btAxisSweep3 btBatchedConstraints btBox2dBox2dCollisionAlgorithm btBox2dShape btBroadphaseProxy
  btCollisionDispatcherMt btCollisionWorldImporter btContactConstraint btContactProcessing btConvex2dConvex2dAlgorithm
  btConvex2dShape btConvexPointCloudShape btConvexTriangleMeshShape btDantzigLCP btDefaultSoftBodySolver
  btDiscreteDynamicsWorldMt btGImpactBvh btGImpactCollisionAlgorithm btGImpactQuantizedBvh btGImpactShape
  btGenericPoolAllocator btGhostObject btInternalEdgeUtility btKinematicCharacterController btLemkeAlgorithm
  btMLCPSolver btMinkowskiSumShape btMultiBodyMLCPConstraintSolver btMultiSphereShape btMultimaterialTriangleMeshShape
  btNNCGConstraintSolver btRaycastVehicle btReducedDeformableBodyHelpers btReducedDeformableBodySolver
  btScaledBvhTriangleMeshShape btSequentialImpulseConstraintSolverMt btSerializer btSerializer64 btShapeHull
  btSimpleBroadphase btSimpleDynamicsWorld btSimulationIslandManagerMt btSoftMultiBodyDynamicsWorld
  btSoftRigidDynamicsWorld btSolve2LinearConstraint btSphereBoxCollisionAlgorithm btTaskScheduler btTetrahedronShape
  btThreadSupportPosix btThreadSupportWin32 btTriangleBuffer btTriangleIndexVertexMaterialArray btTriangleMesh
  btTriangleShapeEx btUniformScalingShape btWheelInfo gim_box_set gim_contact gim_memory gim_tri_collision)
list(JOIN unused "|" unused)
foreach(part LinearMath BulletCollision BulletDynamics BulletSoftBody)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${bullet}/src/${part}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "/(${unused})[.]cpp$")
  add_library(${part} STATIC EXCLUDE_FROM_ALL ${sources})
  target_include_directories(${part} SYSTEM PUBLIC "${bullet}/src")
  if(MSVC)
    target_compile_options(${part} PRIVATE /w)
  else()
    target_compile_options(${part} PRIVATE -w -ffp-contract=off)
  endif()
  set_target_properties(${part} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  # A header there can be included only once.
  list(FILTER sources INCLUDE REGEX "/btReduced")
  set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endforeach()
add_library(tetskin::bullet_physics INTERFACE IMPORTED GLOBAL)
target_link_libraries(tetskin::bullet_physics INTERFACE BulletSoftBody BulletDynamics BulletCollision LinearMath)
target_include_directories(tetskin::bullet_physics SYSTEM INTERFACE "${bullet}/src")
