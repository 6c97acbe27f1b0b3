# The README's first program must be identical to demos/hello.cpp.
file(READ README.md readme)
file(READ demos/hello.cpp program)
string(FIND "${readme}" "```cpp\n${program}```" place)
if(place EQUAL -1)
  message(FATAL_ERROR "README.md does not show demos/hello.cpp as it is: copy it there")
endif()
