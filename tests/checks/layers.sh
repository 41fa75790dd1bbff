#!/bin/sh
# Reads every #include line of the tree and holds them against layers.txt.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
"$here/sources.sh" .h .cpp | awk -v rules="$here/layers.txt" '
function is_under(path, folder) { return path == folder || index(path, folder "/") == 1 }
function begins(text, start) { return index(text, start) == 1 }
function wrong(what) { printf "%s:%d: %s\n", file, line, what; failed = 1 }
function folder_of(path,   best, f) {
  best = ""
  for (f in may) if (is_under(path, f) && length(f) > length(best)) best = f
  return best
}
function check_ours(header,   i, n, list) {
  if (header !~ "/") return wrong("#include \"" header "\" must be written from the root of the tree")
  target = folder_of(header)
  if (target == "") return wrong(header " lies in no folder of layers.txt")
  if ((getline ignored < header) < 0) wrong(header " does not exist")
  close(header)
  if (target == folder) return
  n = split(may[folder], list, " ")
  for (i = 1; i <= n; ++i) if (list[i] == "*" || is_under(target, list[i])) return
  wrong(folder " may not include " header "; it may include: " (n ? may[folder] : "nothing"))
}
function check_others(header,   start, i, n, list, is_allowed) {
  for (start in only) if (begins(header, start)) {
    n = split(only[start], list, " ")
    is_allowed = 0
    for (i = 1; i <= n; ++i) if (is_under(file, list[i])) is_allowed = 1
    if (!is_allowed) wrong("<" header "> is only for " only[start])
  }
  n = split(never[folder], list, " ")
  for (i = 1; i <= n; ++i)
    if (header == list[i] || (list[i] ~ "/$" && begins(header, list[i])))
      wrong(folder " does no I/O, starts no thread, reads no clock: not <" header ">")
}
BEGIN {
  while ((getline rule < rules) > 0) {
    if (rule ~ /^ *(#|$)/) continue
    colon = index(rule, ":")
    split(substr(rule, 1, colon - 1), left, " ")
    right = substr(rule, colon + 1)
    gsub(/^ +| +$/, "", right)
    gsub(/ +/, " ", right)
    if ((left[1] SUBSEP left[2]) in ruled) { print rules ": a second rule: " rule; failed = 1 }
    ruled[left[1], left[2]] = 1
    if (left[1] == "may") may[left[2]] = right
    else if (left[1] == "only") only[left[2]] = right
    else if (left[1] == "never") never[left[2]] = right
    else { print rules ": not a rule: " rule; failed = 1 }
  }
}
{
  file = $0
  folder = folder_of(file)
  line = 0
  if (folder == "") { wrong("lies in no folder of layers.txt"); next }
  ++files
  while ((getline text < file) > 0) {
    ++line
    if (text !~ /^[ \t]*#[ \t]*include/) continue
    header = text
    ++includes
    if (text ~ /"/) { sub(/^[^"]*"/, "", header); sub(/".*/, "", header); check_ours(header) }
    else { sub(/^[^<]*</, "", header); sub(/>.*/, "", header); check_others(header) }
  }
  close(file)
}
END {
  if (!files) { print "no source file found: the check itself is broken"; failed = 1 }
  printf "%d #include lines of %d files read\n", includes, files
  exit failed
}'
