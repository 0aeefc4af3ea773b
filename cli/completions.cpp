// `relook completions`: scripts for bash, zsh and fish that ask `relook complete` what may stand at the end of a line.
#include "verbs.h"

namespace relook {
namespace {

// Words are compared by the program, not by compgen -W, which would run what stands in a name. Bash splits at "=", so
// that of "--camera=Main" only the value is left to complete.
constexpr const char* kBash = R"shell(_relook() {
  local line word current=${COMP_WORDS[COMP_CWORD]}
  local words=("${COMP_WORDS[@]:1:COMP_CWORD}")
  COMPREPLY=()
  while IFS= read -r line; do
    if [ "$line" = :files ]; then
      compopt -o filenames 2>/dev/null
      [ "$current" = "=" ] && current=
      while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen -f -- "$current")
      continue
    fi
    word=${line%%$'\t'*}
    if [[ $word == --*=* && $current != --* ]]; then word=${word#*=}; fi
    if [[ $word == */ ]]; then compopt -o nospace 2>/dev/null; fi
    COMPREPLY+=("$(printf %q "$word")")
  done < <("${1/#\~/$HOME}" complete "${words[@]//[\\\"\']/}" 2>/dev/null)
}
complete -F _relook relook
)shell";

constexpr const char* kZsh = R"shell(#compdef relook
_relook() {
  local line word
  local -a plain shown open
  for line in "${(@f)$("${(Q)~words[1]}" complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
    word=${line%%$'\t'*}
    if [[ $line == :files ]]; then _files
    elif [[ $word == */ ]]; then open+=("$word")
    elif [[ -n $word ]]; then
      plain+=("$word")
      shown+=("${line/$'\t'/  -- }")
    fi
  done
  compadd -l -d shown -a plain
  compadd -S '' -a open
}
if [ "$funcstack[1]" = _relook ]; then _relook "$@"; else compdef _relook relook; fi
)shell";

constexpr const char* kFish = R"shell(function __relook_complete
  set -l words (commandline -opc)
  set -l current (commandline -ct)
  set -l program $words[1]
  set -e words[1]
  for line in ($program complete $words "$current" 2>/dev/null)
    if test "$line" = :files
      __fish_complete_path "$current"
    else
      echo $line
    end
  end
end
complete -c relook -f -a '(__relook_complete)'
)shell";

}  // namespace

ExitCode run_completions(const Arguments& arguments, Console& console) {
  const std::string& shell = arguments.inputs[0];
  console.print(shell == "bash" ? kBash : shell == "zsh" ? kZsh : kFish);
  return ExitCode::ok;
}

}  // namespace relook
