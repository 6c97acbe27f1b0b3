# The pages whose commands, snippets and links are all tested, by their paths in the repository; only those that exist.
# In:   a variable `repository`
# Out:  a list `pages`
set(pages README.md plugin/README.md demos/README.md tests/README.md)
foreach(page ${pages})
  if(NOT EXISTS ${repository}/${page})
    list(REMOVE_ITEM pages ${page})
  endif()
endforeach()
