#!/usr/bin/env bash
# Every example, as small as it goes: each checks its own answer and exits with 0 only where it is right.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99

examples=("$SRCDIR"/examples/[0-9]*.c)
echo "1..${#examples[@]}"
count=0
for source in "${examples[@]}"; do
  name=$(basename "$source" .c)
  arguments=()
  [[ $name == 03_* ]] && arguments=(20) # particles across the height of the column
  count=$((count + 1)) start=$SECONDS
  # What these two drive is not there everywhere: configure says so, and they are not built.
  if [[ $name =~ _(cvode|petsc)$ && ! -x $BUILDDIR/examples/$name ]]; then
    echo "ok $count - $name # SKIP configure found no ${BASH_REMATCH[1]^^}"
    continue
  fi
  if "$BUILDDIR/examples/$name" "${arguments[@]}" >log 2>&1 </dev/null; then
    echo "ok $count - $name ($((SECONDS - start)) s)"
  else
    echo "not ok $count - $name: exit status $?"
  fi
  sed 's/^/# /' log
done
