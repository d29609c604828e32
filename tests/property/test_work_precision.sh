#!/usr/bin/env bash
# sphode work-precision: orders, costs and failures that it tells of a wave and of a gas.
source "$SRCDIR/tests/tap.sh"
wave=$SRCDIR/cases/acoustic-wave-1d.yml
sod=$SRCDIR/cases/sod-1d.yml

refused() { # STATUS, name, what the message says, arguments...
  local status=$1 name=$2 says=$3
  shift 3
  run "$status" "$sphode" work-precision "$@" && grep -q "^sphode: .*$says" err && [[ ! -s out ]]
  ok $? "$name"
}
# column INTEGRATOR VALUE NAME: of DIR/work-precision.csv
column() {
  awk -F, -v integrator="$1" -v value="$2" -v name="$3" '
    /^#/ { next }
    !n { for (n = 1; n <= NF; n++) { sub(/ \[.*/, "", $n); k[$n] = n }; next }
    $1 == integrator && $3 + 0 == value + 0 { print $k[name] }' "$dir/work-precision.csv"
}
true_that() { awk "BEGIN { exit !($1) }"; }
# order INTEGRATOR COARSE FINE WANTED: of the error of velocity against the steps that were made
order() {
  local a b p q
  a=$(column "$1" "$2" velocity) b=$(column "$1" "$3" velocity)
  p=$(column "$1" "$2" steps) q=$(column "$1" "$3" steps)
  echo "# $1: error $a in $p steps, $b in $q: order $(awk "BEGIN { print log($a / $b) / log($q / $p) }"), wanted $4"
  true_that "log($a / $b) / log($q / $p) > $4 - 0.15 && log($a / $b) / log($q / $p) < $4 + 0.25"
}

# ---- a linear wave: f is smooth, errors are the schemes' own

dir=wave
methods=leapfrog,erk:bogacki-shampine-4-2-3,erk:heun-euler-2-1-2,erk:zonneveld-5-3-4
run 0 "$sphode" work-precision "$wave" -o wave --fixed --set parameters.e=1e-3 --integrators $methods \
  --cfl 8,0.5,0.25,0.125 &&
  [[ -s wave/work-precision.csv && -s wave/work-precision.txt ]] &&
  for m in ${methods//,/ }; do grep -q "^$m$" out || break; done
ok $? "a sweep of fixed steps leaves tables"
good=0
order leapfrog 0.25 0.125 2 || good=1
order erk:heun-euler-2-1-2 0.25 0.125 2 || good=1
order erk:bogacki-shampine-4-2-3 0.25 0.125 3 || good=1
order erk:zonneveld-5-3-4 0.25 0.125 4 || good=1
ok $good "orders of four schemes"
# Of order three with three stages: y exp(i w dt) but for (w dt)^4/24 a step; the wave has the amplitude e c = 1e-3 c.
error=$(column erk:bogacki-shampine-4-2-3 0.125 velocity) steps=$(column erk:bogacki-shampine-4-2-3 0.125 steps)
theory=$(awk "BEGIN { w = 6.283185307; print 1e-3 / sqrt(2) * w^4 / 24 / $steps^3 }")
echo "# $error, by the expansion of exp(z) $theory"
true_that "$error > 0.97 * $theory && $error < 1.03 * $theory"
ok $? "the error of a wave is that of the scheme"
good=0
stages() { # INTEGRATOR EVALUATIONS-A-STEP
  local steps evaluations
  steps=$(column "$1" 0.25 steps) evaluations=$(column "$1" 0.25 evaluations)
  echo "# $1: $evaluations evaluations in $steps steps"
  true_that "$evaluations >= $2 * $steps && $evaluations <= $2 * $steps + 3" || good=1
}
stages leapfrog 1
stages erk:heun-euler-2-1-2 2
stages erk:bogacki-shampine-4-2-3 3
stages erk:zonneveld-5-3-4 5
ok $good "evaluations are the stages of each step"
[[ $(column erk:zonneveld-5-3-4 8 velocity) == nan ]] && column erk:zonneveld-5-3-4 8 outcome | grep -q "admissible" &&
  grep -q "cfl 8 .*failed: " out
ok $? "eight times the stability limit is a row with its reason"
floor=$(sed -n "s|^# reference:.* velocity \([^,]*\),.*|\1|p" wave/work-precision.csv)
least=$(awk -F, '
  /^#/ { next }
  !k { for (k = 1; $k != "velocity"; k++); next }
  $k + 0 > 0 && (!n++ || $k < least) { least = $k }
  END { print least }' wave/work-precision.csv)
echo "# reference $floor, least $least"
true_that "$floor > 0 && $floor <= 0.1 * $least"
ok $? "the reference is ten times better than the best"
if command -v gnuplot >/dev/null; then
  [[ -s wave/evaluations.png && -s wave/seconds.png ]]
  ok $? "two pictures"
else
  ok 0 "two pictures # SKIP no gnuplot"
fi

# ---- a gas: tolerances, energy, other keys and ends

dir=sod
small=(--set parameters.n=50 --until 0.1s)
run 0 "$sphode" work-precision "$sod" "${small[@]}" -o sod --tolerances 1e-4,1e-6 --cfl 0.35,0.2 \
  --integrators erk:bogacki-shampine-4-2-3,erk:bogacki-shampine-4-2-3+dt_max=1e-3,leapfrog --field energy -t 2
ok $? "a sweep of tolerances"
m=erk:bogacki-shampine-4-2-3
true_that "$(column $m 1e-6 energy) < 0.2 * $(column $m 1e-4 energy) && $(column $m 1e-6 steps) > 2 * $(column $m 1e-4 steps)" &&
  true_that "$(column $m+dt_max=1e-3 1e-4 steps) == 100 && $(column leapfrog 0.2 energy) < $(column leapfrog 0.35 energy)"
ok $? "a smaller tolerance is a smaller error; keys behind a + are the integrator's"
grep -q "^Evaluations for an error of energy" out && grep -q "^end  *t = 0.1 s, 100 particles" out
ok $? "the summary tells the field and the end that were asked for"

# Parts of terms are left aside by those that step all alike.
dir=couette
run 0 "$sphode" work-precision "$SRCDIR/cases/couette-2d.yml" -o couette --until 0.002s --cfl 0.35,0.2 --tolerances 1e-2,1e-4 \
  --set parameters.n=20 --set terms.viscosity-laminar.part=implicit --integrators leapfrog,imex:ark324l2sa-4-2-3
m=imex:ark324l2sa-4-2-3
[[ $(column leapfrog 0.2 implicit) == 0 && $(column $m 1e-4 implicit) -gt 0 && $(column $m 1e-4 iterations) -gt 0 ]] &&
  true_that "$(column leapfrog 0.2 velocity) < 0.01 && $(column $m 1e-4 velocity) < 0.2 * $(column $m 1e-2 velocity)" &&
  grep -q "evaluations .*implicit .*solves .*iterations" out
ok $? "explicit and implicit steps of the same case"

dir=slow
run 0 "$sphode" work-precision "$wave" -o slow -q --integrators leapfrog --cfl 0.35,1e-6 --timeout 1 &&
  column leapfrog 1e-6 outcome | grep -q "longer" && [[ $(column leapfrog 0.35 outcome) == done && ! -s out && ! -s err ]]
ok $? "a run that takes too long is a row, and --quiet says nothing"

# ---- refused

refused 1 "an unknown integrator tells the nearest" "leapfog.* is unknown; the nearest is .leapfrog" "$wave" --integrators leapfog -o x
refused 1 "an unknown key behind a +" "unknown key 'lniear'" "$wave" --integrators leapfrog+lniear=pcg -o x
refused 1 "a case that is not there" "No such file" nothing.yml -o x
refused 1 "an end without its unit's kind" "run.end" "$wave" --until 3kg -o x
refused 1 "a directory with results" "holds a run that ended or was stopped" "$sod" "${small[@]}" -o sod
refused 2 "a tolerance that is no number" "--tolerances 1e-3,x: wanted" "$wave" --tolerances 1e-3,x -o x
refused 2 "a step of zero" "--cfl 0: wanted" "$wave" --cfl 0 -o x
refused 2 "an unknown field tells the known ones" "known are position, velocity, density" "$wave" --field pressure -o x
sed 's/^  pressure:.*/&\n  conduction:/' "$wave" >heat.yml
line=$(grep -n "^  conduction" heat.yml | cut -d: -f1)
refused 1 "a term that does not fit, at its place" "heat.yml:$line:3: conduction needs a temperature" heat.yml -o x
[[ ! -e x ]]
ok $? "what is refused writes nothing"
echo "1..$count"
