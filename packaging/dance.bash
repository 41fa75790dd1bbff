# Bash completion of `dance`: commands by what `dance help` lists, options and their words by what --help of the command says.
_dance() {
  local dance=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}
  local commands typed="" words="" help i
  COMPREPLY=()
  commands=$("$dance" help 2>/dev/null | sed -n '/^First steps:/q; s/^  \([a-z][a-z -]*[a-z]\)  *.*/\1/p' | sed 's/  .*//')
  # A command may be of several words: the next word of all that begin as what was typed.
  for ((i = 1; i < COMP_CWORD; i++)); do typed+="${COMP_WORDS[i]} "; done
  [ "$typed" = "help " ] && typed=""
  words=$(sed -n "s/^${typed//[^a-z -]/}\([a-z-]*\).*/\1/p" <<<"$commands" | sort -u)
  [ "$COMP_CWORD" = 1 ] && words+=" help"
  if [ "$COMP_CWORD" -gt 1 ]; then
    # The options of the command, which is the words before the first option.
    typed=${typed%% -*}
    help=$("$dance" help $typed 2>/dev/null) || help=""
    words+=" $(grep -oE '^  (-[a-z],)?--[a-z-]+' <<<"$help" | grep -oE -- '--[a-z-]+')"
    # Of an option that takes one of several words, those.
    if [[ $previous == --* ]]; then
      i=$(sed -n "s/^  \(-[a-z],\)\{0,1\}$previous [A-Z]*:{\([^}]*\)}.*/\2/p" <<<"$help")
      [ -z "$i" ] || words=${i//,/ }
    fi
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -o default -F _dance dance
