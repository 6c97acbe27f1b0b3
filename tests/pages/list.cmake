# The pages whose commands, snippets and links are all tested, by their paths in the repository; only those that exist.
# In:   a variable `repository`
# Out:  lists `pages`, and `topics`: those of them in plugin/docs, each of which has one program
file(GLOB topics RELATIVE ${repository} CONFIGURE_DEPENDS ${repository}/plugin/docs/*.md)
set(pages README.md plugin/README.md ${topics} plugin/CHANGES.md demos/README.md tests/README.md tests/BULLET_DEFECTS.md
  .github/CONTRIBUTING.md)
foreach(page ${pages})
  if(NOT EXISTS ${repository}/${page})
    list(REMOVE_ITEM pages ${page})
  endif()
endforeach()
