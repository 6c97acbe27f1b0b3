# Pages of the repository as pages of the documentation, which has neither the files around them nor anchors for their
# headings, and allows each name only once: a heading's is <page>-<heading as links name it>, a page's is page_<page>.
# Blocks of code are left alone.
function of_page(file) {
  sub(/.*\//, "", file)
  sub(/[.]md$/, "", file)
  return file == "README" ? "guide" : tolower(file)
}

function anchor(heading) {
  heading = tolower(heading)
  gsub(/[^a-z0-9 _-]/, "", heading)
  gsub(/ /, "-", heading)
  return heading
}

# A link's target in the documentation; empty if it is not part of it.
function place(target, parts) {
  if (target ~ /:/) return target
  split(target, parts, "#")
  if (parts[1] == "") return "#" of_page(FILENAME) "-" parts[2]
  if (FILENAME ~ /\/docs\/[^\/]*$/ ? parts[1] !~ /^([a-z_]+|[.][.]\/(README|CHANGES))[.]md$/ : parts[1] !~ /^(docs\/[a-z_]+|CHANGES)[.]md$/) return ""
  return parts[2] ? "#" of_page(parts[1]) "-" parts[2] : "#page_" of_page(parts[1])
}

# The line with its links as those of the documentation, and its pictures by their names.
function linked(line, result, text, target, picture) {
  result = ""
  while (match(line, /!?\[[^]]*\]\([^) ]*\)/)) {
    text = substr(line, RSTART, RLENGTH)
    result = result substr(line, 1, RSTART - 1)
    line = substr(line, RSTART + RLENGTH)
    picture = text ~ /^!/
    target = text
    sub(/^!?\[[^]]*\]\(/, "", target)
    sub(/\)$/, "", target)
    sub(/\([^(]*\)$/, "", text)
    if (picture) {
      sub(/.*\//, "", target)
    } else {
      target = place(target)
    }
    result = result (target ? text "(" target ")" : substr(text, 2, length(text) - 2))
  }
  return result line
}

/^```/ { code = !code }
code || /^```/ { print; next }
# A link's text may continue in the next line.
{
  while (/\[[^]]*$/ && (getline more) > 0) {
    if (more ~ /^(```|$)/) {
      print linked($0)
      $0 = more
      if (more != "") code = 1
      break
    }
    sub(/^ +/, "", more)
    $0 = $0 " " more
  }
}
code { print; next }
/^#+ / {
  heading = linked($0)
  name = $0
  sub(/^#+ /, "", name)
  print heading " {#" (/^# / ? "page_" of_page(FILENAME) : of_page(FILENAME) "-" anchor(name)) "}"
  next
}
{ print linked($0) }
