# The manual page of a program, from what its --help prints (CLI11's layout); of `dance` itself, from `dance help`.
#   dance-salsa --help | awk -v name=dance-salsa -v version=0.1.0 -f packaging/man_page.awk
function escaped(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  return (text ~ /^[.']/ ? "\\&" : "") text
}
function section(title) { print ".SH " toupper(title) }
# An entry's term stands left of column 30 and its text right of it, or below it where the term is long.
function entry(term, text) {
  gsub(/^ +| +$/, "", term)
  print ".TP\n.B " escaped(term) "\n" escaped(text)
}
function verbatim(on) {
  if (on != is_verbatim) print on ? ".nf" : ".fi"
  is_verbatim = on
}
{ lines[NR] = $0 }
END {
  margin = sprintf("%30s", "")
  for (i = 1; i <= NR && lines[i] !~ /^[Uu]sage: /; ++i) purpose = purpose (i > 1 ? " " : "") lines[i]
  if (i > NR) { print name ": its help has no usage" >"/dev/stderr"; exit 1 }
  if (purpose == "") purpose = "dancing together, in time, from different places"
  sub(/[. ]+$/, "", purpose)
  print ".TH " toupper(name) " 1 \"\" \"DanceGraph " version "\" \"DanceGraph\""
  section("Name")
  print name " \\- " escaped(purpose)
  section("Synopsis")
  usage = lines[i]
  sub(/^[^ ]* /, "", usage)
  sub(/   +\(.*/, "", usage)
  print ".B " escaped(usage)
  if (name == "dance") section(kind = "Commands")
  for (++i; i <= NR; ++i) {
    line = lines[i]
    # What measures and trains stays in the source tree.
    if (line ~ /^Measuring and training:$/) kind = "skipped"
    else if (line ~ /^[A-Z][A-Za-z ]*:$/) {
      kind = line
      sub(/:$/, "", kind)
      verbatim(0)
      section(kind)
    } else if (line == "") {
      if (is_verbatim) print ""
    } else if (kind == "skipped") continue
    else if (kind ~ /^(Options|Positionals)$/) {
      if (i < NR && index(lines[i + 1], margin) == 1) entry(line, substr(lines[++i], 31))
      else entry(substr(line, 1, 30), substr(line, 31))
    } else if (kind == "Commands") {
      split(line, parts, /  +/)
      entry(parts[2], parts[3])
    } else {
      verbatim(line ~ /^ /)
      print escaped(line)
    }
  }
  verbatim(0)
  section("See also")
  if (name == "dance") print "The manual pages dance\\-demo(1) and so on of its commands, or \\fBdance help\\fR \\fICOMMAND\\fR."
  else print ".BR dance (1)"
}
