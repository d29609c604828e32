# Sourced by tests: the program, a folder of their own, and TAP.
sphode=${SPHODE:-$BUILDDIR/sphode}
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99
export OMP_WAIT_POLICY=passive

count=0
ok() { # 0 or not, name
  count=$((count + 1))
  [[ $1 == 0 ]] && echo "ok $count - $2" && return
  echo "not ok $count - $2"
  sed 's/^/# /' out err 2>/dev/null
}
run() { # STATUS COMMAND...: standard output to out, errors to err; true where it exits with STATUS
  local wanted=$1 status
  shift
  "$@" >out 2>err
  status=$?
  [[ $status == "$wanted" ]] && return
  echo "# exit status $status, wanted $wanted: $*"
  return 1
}
