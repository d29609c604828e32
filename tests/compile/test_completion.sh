#!/usr/bin/env bash
# Completion in bash and in zsh (where it is there), as a user types.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99
mkdir bin results
ln -s "$BUILDDIR/sphode" bin/sphode
PATH=$stage/bin:$PATH
cp "$SRCDIR/cases/dam-break-2d.yml" case.yml
echo notes >notes.txt

count=0
# offers NAME FOUND WORD...: these words are offered; one that begins with ! is not.
offers() {
  local name=$1 found=" $2 " word right=0
  shift 2
  for word; do
    if [[ $word == !* ]]; then [[ $found != *" ${word#!} "* ]]; else [[ $found == *" $word "* ]]; fi || right=1
    ((right)) && echo "# '$word' in: $found" && break
  done
  count=$((count + 1))
  ((right)) && echo "not ok $count - $name" || echo "ok $count - $name"
}

complete_bash() { # WORD...: what is offered for the last one
  bash -c 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _sphode 2>errors; cat errors; echo "${COMPREPLY[*]}"' \
    "$BUILDDIR/completions/sphode" "$@" 2>&1
}
# An interactive zsh on a terminal of its own, in which the line is typed, then Tab; all that is added is kept in a file.
cat >zshrc <<'END'
unset zle_bracketed_paste
fpath=($COMPLETIONS $fpath)
autoload -U compinit && compinit -u -D
compadd() {
  local -a hits
  if [[ " $* " != *' -'[OAD]' '* ]]; then
    builtin compadd -O hits "$@"
    print -rl -- $hits >>offered
  fi
  builtin compadd "$@"
}
mark() { : >marked }
zle -N mark
bindkey '^Xm' mark
: >ready
END
complete_zsh() { # LINE
  rm -f offered marked ready
  COMPLETIONS=$BUILDDIR/completions zsh -f -c '
    zmodload zsh/zpty
    zpty shell zsh -f -i
    zpty -w shell "source ./zshrc"
    for wait in ready marked; do
      for k in {1..600}; do [[ -e $wait ]] && break; sleep 0.1; zpty -rt shell text; done
      [[ $wait == ready ]] && zpty -n -w shell "$1"$'"'\\t\\C-xm'"'
    done
    zpty -d shell' zsh "$1" >zpty 2>&1
  tr '\n' ' ' <offered 2>/dev/null
}

lists=$(sphode help | sed -n 's/^  info .*: //p' | tr -d ,)
options=$(sphode run --help | grep -oE '^ +(-[a-z], |    )--[a-z-]+' | grep -oE -- '--[a-z-]+')
commands=$(sphode help | awk '/^  [a-z-]+ +[][A-Z]/ && $1 != "sphode" { print $1 }')
(($(wc -w <<<"$options") > 4 && $(wc -w <<<"$commands") > 7))
offers "there is something to offer" "$?" 0
offers "bash: commands" "$(complete_bash sphode '')" $commands '!sphode'
offers "bash: options of the command" "$(complete_bash sphode run -)" $options -o '!--json'
offers "bash: case files" "$(complete_bash sphode run '')" case.yml results/ '!notes.txt'
offers "bash: directories" "$(complete_bash sphode plot '')" results/ '!case.yml'
offers "bash: directories behind -o" "$(complete_bash sphode run -o '')" results/ '!case.yml'
offers "bash: lists" "$(complete_bash sphode info '')" $lists
offers "bash: keys" "$(complete_bash sphode run case.yml --set '')" spacing= kernel. groups.
offers "bash: keys of a group in the file" "$(complete_bash sphode run case.yml --set groups.)" groups.water. groups.tank. '!groups.lower.'
offers "bash: keys below" "$(complete_bash sphode run -s groups.water.eos.tait.g)" groups.water.eos.tait.gamma= '!groups.water.eos.tait.match='
offers "bash: parameters" "$(complete_bash sphode run case.yml --set parameters.)" parameters.dx= parameters.H=
offers "bash: names in the middle" "$(complete_bash sphode run case.yml --set output.monitors.)" output.monitors.front.
offers "bash: words of a key" "$(complete_bash sphode run --set search = '')" grid tree '!search'
offers "bash: words of a key, begun" "$(complete_bash sphode run --set search = g)" grid '!tree'
offers "bash: --set=" "$(complete_bash sphode run --set = spac)" spacing= '!speed='
offers "bash: integrators" "$(complete_bash sphode work-precision --integrators leap)" leapfrog
offers "bash: templates" "$(complete_bash sphode new '')" tank piston channel gas piston-hill-3d '!or' '!(default)'
offers "bash: fields" "$(complete_bash sphode plot results --field '')" velocity pressure density velocity_x '!...'
offers "bash: nothing wrong with an unknown command" "$(complete_bash sphode nothing '')" '!case.yml'

if command -v zsh >/dev/null; then
  offers "zsh: commands" "$(complete_zsh 'sphode ')" $commands
  offers "zsh: options" "$(complete_zsh 'sphode run --')" $options
  offers "zsh: case files" "$(complete_zsh 'sphode run ')" case.yml '!notes.txt'
  offers "zsh: keys" "$(complete_zsh 'sphode run case.yml --set groups.')" groups.water. groups.tank.
  offers "zsh: words of a key" "$(complete_zsh 'sphode run --set search=')" grid tree
  offers "zsh: templates" "$(complete_zsh 'sphode new ')" tank piston-hill-3d '!or'
  offers "zsh: fields" "$(complete_zsh 'sphode plot results --field ')" velocity pressure
else
  for what in commands options "case files" keys "words of a key" templates fields; do
    echo "ok $((++count)) - zsh: $what # SKIP no zsh"
  done
fi
echo 1..$count
