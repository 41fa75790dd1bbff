# What ./dance shows while packages are installed and programs are built; bash, read by ./dance.
# On a terminal one line that is updated in place, elsewhere a line every 15 s.

shown_at=-100 is_line_open=no

show_progress() { # TEXT
  if [ -t 2 ]; then
    printf '\r\033[Kdance: %s' "$1" >&2
    is_line_open=yes
  elif ((SECONDS - shown_at >= 15)); then
    printf 'dance: %s\n' "$1" >&2
    shown_at=$SECONDS
  fi
}

end_progress() {
  [ $is_line_open = no ] || printf '\r\033[K' >&2
  is_line_open=no shown_at=-100
}

# run_watched FUNCTION LOG COMMAND…: the command's lines go to the end of LOG; FUNCTION gets each of them, and an empty one
# for each second without any. Ends as the command does.
run_watched() {
  local function=$1 log=$2 line="" part="" output code
  shift 2
  exec {output}< <(code=0; "$@" 2>&1 </dev/null || code=$?; printf '\n=ended %s\n' "$code")
  while :; do
    code=0
    IFS= read -r -t 1 -u "$output" line || code=$?
    line=$part$line part=""
    if ((code > 128)); then # what came of a line before the second was over is kept
      part=$line
      "$function" ""
      continue
    fi
    if ((code != 0)) || [[ $line == "=ended "* ]]; then break; fi
    printf '%s\n' "$line"
    "$function" "$line"
  done >>"$log"
  exec {output}<&-
  end_progress
  [[ $line == "=ended "* ]] || return 1
  return "${line#=ended }"
}

# apt-get's own words: how many packages, then what happens to each.
packages=0 fetched=0 unpacked=0 set_up=0
watch_packages() { # LINE
  case $1 in
    [0-9]*" newly installed"*) [[ $1 =~ ^([0-9]+)\ upgraded,\ ([0-9]+) ]] && packages=$((BASH_REMATCH[1] + BASH_REMATCH[2])) ;;
    Get:*) fetched=$((fetched + 1)) ;;
    "Unpacking "*) unpacked=$((unpacked + 1)) ;;
    "Setting up "*) set_up=$((set_up + 1)) ;;
  esac
  if ((packages == 0)); then
    show_progress "installing: apt-get reads its lists"
  elif ((set_up > 0)); then
    show_progress "installing: $set_up of $packages packages set up, the last step"
  elif ((unpacked > 0)); then
    show_progress "installing: $unpacked of $packages packages unpacked"
  else
    show_progress "installing: $fetched of $packages packages fetched"
  fi
}

# Steps of a build differ a hundredfold: each has a weight, about the milliseconds that it takes on an ordinary processor.
# The first seconds of this build then tell how fast this machine is.
declare -A took_ms=()
read_last_times() { # FOLDER: of an earlier build there, ninja's own record
  local begin end stamp output rest
  took_ms=()
  [ -f "$1/.ninja_log" ] || return 0
  while IFS=$'\t' read -r begin end stamp output rest; do
    [ -z "${output:-}" ] || took_ms[$output]=$((end - begin))
  done < <(grep -v '^#' "$1/.ninja_log")
}

weigh() { # FOLDER STEP: sets weight
  local output=${2##* } sources
  weight=100
  case $2 in
    "Building CXX object "*)
      weight=${took_ms[$output]:-}
      [ -z "$weight" ] || return 0
      weight=2500
      # Several sources in one.
      if [[ $output == */Unity/* ]] && sources=$(grep -c '^#include' "$1/${output%.o}"); then
        weight=$((1700 + 500 * sources))
      fi
      ;;
    "Building C object "*) weight=1500 ;;
    "Linking "*" executable "* | "Linking "*" shared "*) weight=400 ;;
  esac
}

words_of_seconds() { # SECONDS: sets words; rounded, as an estimate is
  local seconds=$((($1 + 9) / 10 * 10))
  ((seconds > 0)) || seconds=10
  words=""
  ((seconds < 60)) || words="$((seconds / 60)) min"
  ((seconds % 60 == 0)) || words+="${words:+ }$((seconds % 60)) s"
}

build_folder="" steps=0 steps_done=0 weight=0 weight_all=0 weight_done=0 build_began=0 weight_of_first=0 first_end=0
watch_build() { # LINE
  if [[ $1 == "step "* ]]; then
    weigh "$build_folder" "${1#step }"
    steps_done=$((steps_done + 1)) weight_done=$((weight_done + weight))
    # Steps that bring the build up to speed say little of the rest.
    if ((first_end == 0 && SECONDS - build_began >= 3)); then
      first_end=$SECONDS weight_of_first=$weight_done
    fi
  fi
  local text="building $steps_done of $steps" words
  local since=$((SECONDS - first_end)) weight_since=$((weight_done - weight_of_first))
  if ((steps_done >= steps)); then
    text="building $steps of $steps"
  elif ((first_end > 0 && since >= 8 && weight_since * 30 > weight_all)); then
    words_of_seconds $(((weight_all - weight_done) * since / weight_since))
    text+=", about $words left"
  fi
  show_progress "$text"
}

# build_watched FOLDER LOG TARGET…: true at once where nothing is to be done.
build_watched() {
  local log=$2 line code=0
  build_folder=$1
  shift 2
  steps=0 steps_done=0 weight_all=0 weight_done=0 weight_of_first=0 first_end=0
  # What the sources of the build itself ask for comes first: only then is it known what there is to do.
  ninja -C "$build_folder" build.ninja >"$log" 2>&1 || return 1
  read_last_times "$build_folder"
  while IFS= read -r line; do
    [[ $line == "step "* ]] || continue
    weigh "$build_folder" "${line#step }"
    steps=$((steps + 1)) weight_all=$((weight_all + weight))
  done < <(NINJA_STATUS="step " ninja -C "$build_folder" -n "$@" 2>&1)
  ((steps > 0)) || return 0
  build_began=$SECONDS
  NINJA_STATUS="step " run_watched watch_build "$log" ninja -C "$build_folder" "$@" || code=$?
  return $code
}
