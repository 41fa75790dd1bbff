#!/bin/sh
# What a file may be: at most 400 lines of at most 100 columns (C and C++), no name that says nothing, no tab or trailing space, one line break at its end;
# no folder with more than 30 sources;
# a header begins with a comment that says what it is for, and labels its threads and its failures.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
"$here/sources.sh" .h .hpp .cpp .c .lcm .sh .cmake CMakeLists.txt | LC_ALL=C awk '
function wrong(what) { printf "%s\n", what; failed = 1 }
{
  file = $0
  if (file ~ /\.lcm$/ && file !~ /^lcmtypes\//) next  # a recorded log, not a message type
  ++files
  if (file ~ /\.(h|cpp)$/) {
    folder = file
    sub(/\/[^\/]*$/, "", folder)
    if (++in_folder[folder] == 31) wrong(folder ": more than 30 sources; it wants sub-folders")
  }
  name = file
  sub(/^.*\//, "", name)
  stem = name
  sub(/\..*/, "", stem)
  if (("_" stem "_") ~ /_(utils?|common|misc|helpers?)_/) wrong(file ": the name says nothing")
  line = 0
  comment = ""
  is_head = 1
  while ((getline text < file) > 0) {
    ++line
    if (text ~ /\t/) wrong(file ":" line ": a tab")
    if (text ~ /[ \r]$/) wrong(file ":" line ": a space at the end")
    columns = text
    gsub(/[\200-\277]/, "", columns)  # bytes that continue a character
    if (file ~ /\.(h|hpp|c|cpp)$/ && length(columns) > 100) wrong(file ":" line ": " length(columns) " columns; at most 100")
    if (is_head && text ~ /^\/\//) comment = comment "\n" text
    else is_head = 0
  }
  close(file)
  if (file ~ /\.(h|cpp)$/ && line > 400) wrong(file ": " line " lines; above 400 it wants a split")
  if (name ~ /\.h$/) {
    if (comment == "") wrong(file ":1: a header begins with a comment on what it is for")
    else {
      if (comment !~ /\n\/\/ Threads: /) wrong(file ":1: no line \"// Threads:\" in the first comment")
      if (comment !~ /\n\/\/ Failure: /) wrong(file ":1: no line \"// Failure:\" in the first comment")
    }
  }
}
END {
  if (!files) { print "no file found: the check itself is broken"; failed = 1 }
  printf "%d files read\n", files
  exit failed
}'
