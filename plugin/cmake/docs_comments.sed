# Turns the headers' comments, which are written for readers, into Doxygen's commands. Every line stays a line, so that
# warnings name the right one.

# The head of a file is about the file.
1s|^// SPDX.*|/// @file|
2s|^// SPDX.*|///|
1,/^#pragma/s|^//( .*)?$|///\1|

# "name  meaning" is a parameter; "Errors  meaning" and its like are paragraphs with a title.
s|^( *///) ([a-z][A-Za-z0-9]*), ([a-z][A-Za-z0-9]*)  +|\1 @param \2,\3 |
s|^( *///) ([a-z][A-Za-z0-9]*)  +|\1 @param \2 |
s|^( *///) ([A-Z][a-z]+)  +|\1 @\L\2 |
s/^( *\/\/\/) (Cost|Errors|Error|Memory): /\1 @\L\2 /

# Move and copy functions, and deleted ones, need no comment.
s/^.*(&&( other)?\) (noexcept|= default)|operator=\(.*\) = default);$//

# Nor do functions that only Bullet calls, up to the next blank line.
/^ *\/\/ What Bullet calls\.$/,/^$/ {
  s|^ *// What Bullet calls\.$|/// @cond|
  s|^$|/// @endcond|
}
