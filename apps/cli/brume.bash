# Completes the commands, options and files of brume in bash. The names are those of its --help.
_brume() {
  local word=${COMP_WORDS[COMP_CWORD]} names
  if ((COMP_CWORD == 1)); then
    names="help $(brume --help | sed -n '/^Commands:/,$s/^  \([a-z]\+\) .*/\1/p')"
  elif [[ $word == -* ]]; then
    local command=("${COMP_WORDS[1]}")
    [[ ${COMP_WORDS[1]} == bake && ${COMP_WORDS[2]} =~ ^(slices|occlusion)$ ]] && command+=("${COMP_WORDS[2]}")
    names=$(brume "${command[@]}" --help 2>/dev/null | grep -o '^  -[-a-z,]*' | tr ',' '\n')
  elif [[ ${COMP_WORDS[1]} == help ]]; then
    names=$(brume --help | sed -n '/^Commands:/,$s/^  \([a-z]\+\) .*/\1/p')
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
}
complete -o filenames -F _brume brume
