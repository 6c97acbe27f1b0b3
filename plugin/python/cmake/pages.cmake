# What the package needs to show worlds: the writer of pages, shared with the demos; the files that pages are made from;
# and three.js, which every page contains, in the layouts of Debian and of three.js itself. Without it the package is
# still built, and its first page says what is missing.
#   TETSKIN_THREE, TETSKIN_ORBIT_CONTROLS  three.min.js, and the OrbitControls.js of the same revision that is no module
set(view "${library}/demos/view")
target_sources(_core PRIVATE "${view}/view_data.cpp" "${view}/view_frames.cpp" "${view}/view_page.cpp")
target_include_directories(_core PRIVATE "${library}/demos")
target_link_libraries(_core PRIVATE tetskin_internals)
target_include_directories(_core SYSTEM PRIVATE "${JSON_INCLUDE}")
file(GLOB view_files CONFIGURE_DEPENDS "${view}/*.html" "${view}/*.css" "${view}/*.js" "${view}/*.txt")
install(FILES ${view_files} DESTINATION tetskin/view)

set(places "${CMAKE_CURRENT_SOURCE_DIR}/three" /usr/share/javascript/three /usr/share/nodejs/three)
find_file(TETSKIN_THREE three.min.js PATHS ${places} PATH_SUFFIXES . build DOC "three.min.js, for pages")
find_file(TETSKIN_ORBIT_CONTROLS OrbitControls.js PATHS ${places} PATH_SUFFIXES . examples/js/controls
  DOC "OrbitControls.js of the same three.js, not the one for modules")
if(TETSKIN_THREE AND TETSKIN_ORBIT_CONTROLS)
  install(FILES "${TETSKIN_THREE}" DESTINATION tetskin/view RENAME three.min.js)
  install(FILES "${TETSKIN_ORBIT_CONTROLS}" DESTINATION tetskin/view RENAME OrbitControls.js)
else()
  message(WARNING "three.js was not found: the package will show nothing, and write no pages. Install it (Debian, "
    "Ubuntu: libjs-three), or set TETSKIN_THREE and TETSKIN_ORBIT_CONTROLS.")
endif()
