# Completes the commands, options and files of brume in bash. The names are those of its --help.
_brume() {
  local word=${COMP_WORDS[COMP_CWORD]} before=("${COMP_WORDS[@]:1:COMP_CWORD-1}") names commands
  # One in a line, some of two words: "bake slices".
  commands=$(brume --help | sed -n '/^Commands:/,$s/^  \([a-z]\+\( [a-z]\+\)\?\)  .*/\1/p')
  local command=("${before[@]:0:1}")
  if [[ $word == -* && ${#before[@]} -gt 0 ]]; then
    grep -qx "${before[*]:0:2}" <<< "$commands" && command=("${before[@]:0:2}")
    names=$(brume "${command[@]}" --help 2> /dev/null | grep -o '^  -[-a-z,]*' | tr ',' '\n')
  elif [[ ${before[*]} == '' || ${before[*]} == help ]]; then
    names=$(cut -d ' ' -f 1 <<< "$commands" | sort -u)
    ((${#before[@]})) || names+=' help'
  elif [[ ${before[*]} == bake || ${before[*]} == 'help bake' ]]; then
    names=$(sed -n 's/^bake //p' <<< "$commands")
    [[ ${before[0]} == help ]] || names+=" $(brume bake --help | sed -n 's/,\| or / /g; s/^  SHAPE //p')"
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
}
complete -o filenames -F _brume brume
