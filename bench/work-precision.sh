#!/usr/bin/env bash
# The figures of docs/work-precision: what each integrator needs for which temporal error.
#
#   bench/work-precision.sh [NAME...]        (also: make work-precision FIGURES="...")
#
# makes those of NAME, or all, again: docs/work-precision/NAME.csv, NAME.txt, NAME-evaluations.png, NAME-seconds.png.
# SPHODE is the program (build/sphode), TO the folder, REPEAT how many runs the quickest of which counts (3).
# Integrators that this SUNDIALS has not are left out.  An hour on two cores.
set -euo pipefail
sphode=$(realpath "${SPHODE:-$(dirname "$0")/../build/sphode}")
cd "$(dirname "$0")/.."
to=${TO:-docs/work-precision}
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
export OMP_WAIT_POLICY=passive

default=erk:bogacki-shampine-4-2-3
explicit=$default,erk:rdpk3spfsal35-6-2-3,erk:ark436l2sa-erk-6-3-4,erk:dormand-prince-7-4-5,leapfrog,predictor-corrector
implicit=$default,imex:ark324l2sa-4-2-3,imex:ark436l2sa-6-3-4,imex:ark548l2sa-8-4-5,lsrk:rkl-2,leapfrog

# Those of the list that this build knows: "imex:ark324l2sa-4-2-3+linear=klu" where it has the name before the +.
known() {
  local names list= method
  names=$("$sphode" info integrators --json | sed -n '/"built": "yes"/s/.*"name": "\([^"]*\)".*/\1/p')
  for method in ${1//,/ }; do
    if grep -qxF "${method%%+*}" <<<"$names"; then list=${list:+$list,}$method; else echo "left out: $method" >&2; fi
  done
  echo "$list"
}

figure() { # NAME CASE INTEGRATORS OPTION...
  local name=$1 case=$2 methods=$3
  shift 3
  ((${#wanted[@]} == 0)) || [[ " ${wanted[*]} " == *" $name "* ]] || return 0
  echo "== $name"
  "$sphode" work-precision "cases/$case.yml" --integrators "$(known "$methods")" --repeat "${REPEAT:-3}" \
    -o "$stage/$name" "$@" | sed -n '/^Evaluations/,/^results/p'
  mkdir -p "$to"
  for kind in csv txt; do
    sed -e "s|$sphode|sphode|g; s| -o $stage/$name||g" "$stage/$name/work-precision.$kind" >"$to/$name.$kind"
  done
  for kind in evaluations seconds; do cp "$stage/$name/$kind.png" "$to/$name-$kind.png"; done
}

wanted=("$@")
fine=1e-2,1e-3,1e-4,1e-5,1e-6
coarse=1e-1,1e-2,1e-3,1e-4,1e-5
figure taylor-green taylor-green-2d $explicit --tolerances $fine --cfl 0.9,0.8,0.7,0.5,0.35,0.175,0.0875
figure drop oscillating-drop-2d $explicit --tolerances $fine --cfl 0.9,0.8,0.7,0.5,0.35,0.175,0.0875
figure sod sod-1d $explicit --tolerances $fine --cfl 1,0.9,0.7,0.5,0.35,0.175,0.0875
figure couette couette-low-re-2d $implicit --tolerances $coarse --cfl 0.35,0.175
figure heat heat-stiff-2d $implicit --field energy --tolerances $coarse --cfl 0.35,0.175
# Drag 1000 times as strong, errors relative to the amplitude of the wave.
figure drag dusty-wave-1d $implicit --tolerances $coarse --cfl 0.35,0.175 \
  --set "parameters.drag=1000 kg/m^3/s" --set parameters.e=1e-3 --set "speed=e*c"
