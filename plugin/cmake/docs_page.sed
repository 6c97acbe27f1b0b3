# A page of the repository as the main page of the documentation, which has neither the files around it nor anchors for
# its headings. Blocks of code are left alone.
/^```/,/^```$/b

# A heading's anchor, as links in the page name it.
/^#+ / {
  h
  s/^#+ (.*)/\L\1/
  s/[^a-z0-9 -]//g
  s/ /-/g
  s/.*/ {#&}/
  x
  G
  s/\n//
}

# Pictures by their names; other files not at all.
s/(!\[[^]]*\]\()[^)]*\/([^)]*)/\1\2/g
s/(^|[^!])\[([^]]*)\]\([^)#:][^):]*\)/\1\2/g
