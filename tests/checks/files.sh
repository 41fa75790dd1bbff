#!/bin/sh
# What a file may be: at most 400 lines of at most 100 columns (C and C++), no name that says nothing, no tab or trailing space, one line break at its end;
# no folder with more than 30 sources;
# a header begins with a comment on what it is for;
# core/program/child_process.cpp alone forks and sends signals, and none to -1, 0 or 1.
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
  may_signal = file == "core/program/child_process.cpp"
  comment = ""
  is_head = 1
  while ((getline text < file) > 0) {
    ++line
    if (text ~ /\t/) wrong(file ":" line ": a tab")
    if (text ~ /[ \r]$/) wrong(file ":" line ": a space at the end")
    columns = text
    gsub(/[\200-\277]/, "", columns)  # bytes that continue a character
    if (file ~ /\.(h|hpp|c|cpp)$/ && length(columns) > 100) wrong(file ":" line ": " length(columns) " columns; at most 100")
    code = text
    sub(/\/\/.*/, "", code)
    if (file ~ /\.(h|hpp|c|cpp)$/ && !may_signal && code ~ /(^|[^A-Za-z_.>])(kill|killpg|tgkill|sigqueue|fork|vfork|forkpty|posix_spawnp?) *\(/)
      wrong(file ":" line ": only core/program/child_process.cpp forks and sends signals; use ChildProcess or send_signal()")
    if (is_head && text ~ /^\/\//) comment = comment "\n" text
    else is_head = 0
  }
  close(file)
  if (file ~ /\.(h|cpp)$/ && line > 400) wrong(file ": " line " lines; above 400 it wants a split")
  if (name ~ /\.h$/) {
    if (comment == "") wrong(file ":1: a header begins with a comment on what it is for")
  }
}
END {
  if (!files) { print "no file found: the check itself is broken"; failed = 1 }
  printf "%d files read\n", files
  exit failed
}'
