# Writes the code that the documentation shows between fences, ```cpp and ```cmake, to files, so that it is compiled and
# stays correct.

# Splits the text `rest`: `before` ends with the next fence, and the new `rest` is the text after it; empty if there is
# no such fence.
macro(next_fence fence)
  string(FIND "${rest}" "${fence}" start)
  if(start EQUAL -1)
    set(rest "")
  else()
    string(LENGTH "${fence}" length)
    math(EXPR start "${start} + ${length}")
    string(SUBSTRING "${rest}" 0 ${start} before)
    string(SUBSTRING "${rest}" ${start} -1 rest)
  endif()
endmacro()

# Writes the blocks of repository/page to folder/<page>_<line>.<language>, where a slash is a _, and appends the files to these lists:
#   programs      C++ with a main(), as it is
#   fragments     other C++, as the body of a function, but for what it includes; what it speaks of, snippet.h declares
#   cmake_blocks
# Compilers name the page and its line in their messages.
function(extract_snippets repository page folder)
  string(REGEX REPLACE "[^A-Za-z0-9]" "_" name ${page})
  foreach(language cpp cmake)
    file(READ ${repository}/${page} rest)
    set(line 1)
    next_fence("```${language}\n")
    while(NOT rest STREQUAL "")
      string(REGEX MATCHALL "\n" newlines "${before}")
      list(LENGTH newlines newlines)
      math(EXPR line "${line} + ${newlines}")
      string(FIND "${rest}" "```" end)
      string(SUBSTRING "${rest}" 0 ${end} block)
      if(language STREQUAL "cmake")
        set(kind cmake_blocks)
      elseif(block MATCHES "int main\\(")
        set(kind programs)
        string(PREPEND block "#line ${line} \"${repository}/${page}\"\n")
      else()
        set(kind fragments)
        string(REGEX MATCHALL "#include [^\n]*\n" includes "${block}")
        string(REPLACE "#include " "// " block "${block}")
        list(JOIN includes "" includes)
        string(CONCAT block "#include \"snippet.h\"\n${includes}void ${name}_${line}() {\n"
          "#line ${line} \"${repository}/${page}\"\n${block}}\n")
      endif()
      set(file ${folder}/${name}_${line}.${language})
      file(CONFIGURE OUTPUT ${file} CONTENT "@block@" @ONLY)
      list(APPEND ${kind} ${file})
      next_fence("```${language}\n")
    endwhile()
  endforeach()
  foreach(kind programs fragments cmake_blocks)
    set(${kind} ${${kind}} PARENT_SCOPE)
  endforeach()
endfunction()
