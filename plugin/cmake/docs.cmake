# Target docs: pages of the public API and of the guide, by Doxygen, in build/docs. Any warning is an error: everything
# public has a comment, and every name that a comment mentions exists.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()

find_program(AWK awk)
if(NOT AWK)
  return()
endif()

set(main_page ${CMAKE_CURRENT_SOURCE_DIR}/README.md)
file(GLOB guide CONFIGURE_DEPENDS docs/*.md)
list(APPEND guide ${CMAKE_CURRENT_SOURCE_DIR}/CHANGES.md)
file(GLOB public_headers CONFIGURE_DEPENDS tetskin/*.h tetskin/*/*.h)
list(FILTER public_headers EXCLUDE REGEX "/export[.]h$")  # export macros of the libraries themselves

set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/docs)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${main_page})
set(DOXYGEN_IMAGE_PATH ${PROJECT_SOURCE_DIR}/demos/pictures ${CMAKE_CURRENT_SOURCE_DIR}/docs)
set(DOXYGEN_STRIP_FROM_PATH ${CMAKE_CURRENT_SOURCE_DIR})
set(DOXYGEN_STRIP_FROM_INC_PATH ${CMAKE_CURRENT_SOURCE_DIR})
set(DOXYGEN_FILTER_PATTERNS "*.h=sed -E -f ${CMAKE_CURRENT_LIST_DIR}/docs_comments.sed"
  "*.md=${AWK} -f ${CMAKE_CURRENT_LIST_DIR}/docs_page.awk")
set(DOXYGEN_HTML_EXTRA_STYLESHEET ${CMAKE_CURRENT_LIST_DIR}/docs.css)
set(DOXYGEN_ALIASES)
foreach(fact Cost Error Errors Lifetime Memory Ownership)
  string(TOLOWER ${fact} command)
  list(APPEND DOXYGEN_ALIASES "${command}=@par ${fact}^^")
endforeach()
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_SORT_MEMBER_DOCS NO)
set(DOXYGEN_EXCLUDE_SYMBOLS *_detail tetskin::SkinData)
# The expansions of the libraries' export macros are of no use to a reader.
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_SEARCH_INCLUDES NO)
set(DOXYGEN_PREDEFINED)
foreach(library core bullet cage contact elastic io reduced replay solver threads touch world)
  string(TOUPPER ${library} upper)
  list(APPEND DOXYGEN_PREDEFINED TETSKIN_${upper}_API=)
endforeach()
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)  # a parameter needs no line if its type and name are clear
doxygen_add_docs(docs ${main_page} ${guide} ${public_headers} COMMENT "Pages of the public headers: ${PROJECT_BINARY_DIR}/docs")
