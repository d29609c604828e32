#!/usr/bin/env bash
# Cases that take seconds, as they come along: each meets its bars; the stiff ones with explicit steps, too.
source "$SRCDIR/tests/tap.sh"

steps() { sed -n 's/^ *"steps": \([0-9]*\).*/\1/p' "$1/summary.json"; }
run() { # name of the run, case, options...
  local name=$1 case=$2
  shift 2
  "$sphode" run "$SRCDIR/cases/$case.yml" -o "$name" -q "$@" >log 2>&1
  local status=$?
  sed -n 's/.*"note": "\(.*\)".*/# \1/p' "$name/summary.json"
  echo "# $name: $(steps "$name") steps"
  [[ $status == 0 ]] || sed 's/^/# /' log
  return $status
}
explicit=(--set integrator.method=leapfrog --set integrator.error_control=false)

for case in dusty-box-2d dusty-wave-1d couette-low-re-2d heat-stiff-2d heat-slab-1d heat-two-media-1d acoustic-wave-1d; do
  run $case $case
  ok $? "$case"
done

run dye taylor-green-dye-2d --set parameters.dx=L/40
ok $? "dye in Taylor-Green vortices"

# Sections through a coarse cavity, before it is steady: mean of all snapshots in the window.
run cavity lid-driven-cavity-2d --set parameters.n=20 --set "run.end=12*L/U" --set "compare.0.window=[8, 12]" \
  --set "compare.1.window=[8, 12]" --set compare.0.bar=0.055 --set compare.1.bar=0.035
ok $? "a lid-driven cavity"

# Implicitly the same accuracy in a small part of the steps.
run couette-explicit couette-low-re-2d --set parameters.n=25 --set compare.0.bar=0.004 "${explicit[@]}" &&
  run couette-implicit couette-low-re-2d --set parameters.n=25 --set compare.0.bar=0.004 &&
  (($(steps couette-explicit) > 40 * $(steps couette-implicit)))
ok $? "Couette at low Reynolds number, explicitly and implicitly"
run heat-explicit heat-stiff-2d --set parameters.dx=L/100 --set compare.0.bar=0.002 "${explicit[@]}" &&
  run heat-implicit heat-stiff-2d --set parameters.dx=L/100 --set compare.0.bar=0.002 &&
  (($(steps heat-explicit) > 20 * $(steps heat-implicit)))
ok $? "stiff heat, explicitly and implicitly"
stiff=(--set "parameters.drag=300 kg/m^3/s" --set "run.end=0.4 s" --set "output.snapshots=0.1 s" --set "compare.0.at=[0.1, 0.2, 0.4]")
run dust-explicit dusty-box-2d "${stiff[@]}" &&
  run dust-implicit dusty-box-2d "${stiff[@]}" --set integrator.method=imex:ark324l2sa-4-2-3 &&
  (($(steps dust-explicit) > 20 * $(steps dust-implicit)))
ok $? "stiff drag, explicitly and implicitly"
echo "1..$count"
