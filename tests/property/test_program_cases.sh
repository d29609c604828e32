#!/usr/bin/env bash
# Making cases: templates, their JSON Schema, sweeps.
source "$SRCDIR/tests/tap.sh"
mkdir temporary && export TMPDIR=$stage/temporary

# ---- templates

good=0
for t in tank piston channel gas; do
  run 0 "$sphode" new $t -q && [[ ! -s out ]] && cmp $t.yml "$SRCDIR/prog/templates/$t.yml" && run 0 "$sphode" check $t.yml &&
    grep -q "^the case  *right, 0 warnings" out || { good=1; sed 's/^/# /' out; }
done
ok $good "each template is written and right as it is, without a warning"
mkdir elsewhere
run 0 "$sphode" new piston-hill-3d -o elsewhere/two.yml && grep -q "elsewhere/two.yml is written, beside it hill.stl" out && cmp elsewhere/two.yml "$SRCDIR/cases/piston-hill-3d.yml" &&
  cmp elsewhere/hill.stl "$SRCDIR/cases/hill.stl" && [[ ! -e hill.stl ]] && run 0 "$sphode" check elsewhere/two.yml && grep -q "^the case  *right, 0 warnings" out
ok $? "one that has a surface has it beside it"
run 1 "$sphode" new piston-hill-3d -o elsewhere/three.yml && grep -q "hill.stl is there already" err && [[ ! -e elsewhere/three.yml ]] &&
  run 2 "$sphode" new hill.stl && ! grep -q "^  hill" err
ok $? "it is kept where it is there, and no template itself"
cp tank.yml before
run 1 "$sphode" new && grep -q "tank.yml is there already" err && cmp tank.yml before
ok $? "a file that is there is kept"
run 0 "$sphode" new gas -f -o tank.yml && cmp tank.yml gas.yml && grep -q "sphode run tank.yml" out
ok $? "--force writes over it, and what to do next is told"
run 0 "$sphode" new gas -o - && cmp out gas.yml
ok $? "to standard output"
run 2 "$sphode" new nothing && grep -q "no template 'nothing'" err && grep -q "^  piston " err
ok $? "an unknown template names the known ones"
run 0 "$sphode" run gas.yml -q && [[ -s gas/summary.json ]]
ok $? "one runs as it is, within its bar"

# ---- check

fails() { # NAME, what the message says, --set...
  local name=$1 says=$2 sets=()
  shift 2
  for s; do sets+=(--set "$s"); done
  run 1 "$sphode" check tank2.yml "${sets[@]}" && grep -q "^sphode: .*$says" err
  ok $? "$name"
}
"$sphode" new tank -o tank2.yml -q
printf 'time,front\n0,0.6\n0.1,0.7\n' >front.csv
fails "a probe of a field that is none" "probe a: water has no field .presure.; did you mean 'pressure'" "output.probes={a: {at: [0, 0], fields: presure}}"
fails "a probe elsewhere" "probe a: its places lie" "output.probes={a: {at: [100, 0]}}"
fails "a monitor of no fluid" "monitor a: no fluid group" "output.monitors={a: {type: height, group: nobody}}"
fails "a comparison of no column" "'frnt' is no column of series.csv" "compare=[{name: a, quantity: frnt, norm: mean, reference: {value: 1}}]"
fails "a comparison without its table" "cannot read no.csv" "compare=[{name: a, quantity: front, reference: {csv: {file: no.csv}}}]"
fails "a comparison of no field" "water has no field 'velocty'; did you mean 'velocity'" \
  "compare=[{name: a, quantity: velocty, reference: {column: {surface: 1, gravity: 1}}}]"
column="reference: {column: {surface: H, gravity: g}}"
fails "a quantity that a solution has not" "quantity: found 'velocity'; a column at rest has pressure, density" "compare=[{name: a, quantity: velocity, $column}]"
fails "a norm that a solution does not know" "norm: solutions in space and sections know rms, l1, max" "compare=[{name: a, quantity: pressure, norm: decay, $column}]"
fails "a norm of one number, of a table" "norm: drift, period, decay go with reference: value" "compare=[{name: a, quantity: front, norm: period, reference: {csv: {file: front.csv}}}]"
fails "a norm of points, of one number" "reference: value with norm rms, which compares the points of a curve; right is norm: mean, arrival" "compare=[{name: a, quantity: front, reference: {value: 0.1}}]"
fails "a time behind the end" "at: 3 s is behind the end of the run, 1 s" "compare=[{name: a, quantity: pressure, at: [0.5 s, 3 s], $column}]"
fails "a time without a snapshot" "at: there will be no snapshot at t = 0.33 s; output: snapshots makes one each 0.05 s" "compare=[{name: a, quantity: pressure, at: [0.33 s], $column}]"
fails "times of a table" "at: belongs to solutions in space" "compare=[{name: a, quantity: front, at: [0.5 s], reference: {csv: {file: front.csv}}}]"
fails "a window upside down" "window: found from 1 to 0" "compare=[{name: a, quantity: front, window: [1, 0], reference: {csv: {file: front.csv}}}]"
fails "a section behind the end" "window: it begins at 4 s, behind the end of the run, 1 s" "compare=[{name: a, quantity: velocity_x, time_scale: 2 s, window: [2, 3], reference: {section: {file: front.csv, axis: x, through: [0, 0]}}}]"
fails "an axis of a section" "axis: there is no z in 2 dimensions" "compare=[{name: a, quantity: velocity_x, reference: {section: {file: front.csv, axis: z, through: [0, 0]}}}]"
fails "a layer of no group" "layers: there is no fluid 'oil'" "compare=[{name: a, quantity: pressure, reference: {layers: {lower: water, upper: oil, meet: 0, surface: 1, gravity: 1}}}]"
fails "a surface of no temperature" "wall tank: the temperature of its surface is -.* K at (.*) m, t = 0 s; right is > 0" "groups.tank.boundary.temperature=1 K - 1 K/m*x" \
  "terms.conduction=" "groups.water.conductivity=1" "groups.water.specific_heat=4000" "groups.water.energy=temperature" "groups.water.initial.temperature=300"
run 0 "$sphode" check tank2.yml --set "compare=[{name: a, quantity: front, reference: {csv: {file: front.csv}}}]" && grep -q "right, 0 warnings" out
ok $? "one that is right"
run 1 "$sphode" check tank2.yml --set "compare=[{name: a, quantity: front, reference: {csv: {file: front.csv, y: back}}}]" && grep -q "back" err
ok $? "a table without its column"

good=0
for f in "window: [5, 6], time_scale: 0.01s, reference: {csv: {file: front.csv}}=no point of the reference is in the window and below up_to" \
  "norm: arrival, threshold: 9, reference: {value: 1}=the run does not pass the threshold in the window"; do
  run 3 "$sphode" run tank2.yml --set run.end=0.1s --set output.snapshots=0.1s --set "compare=[{name: a, quantity: front, bar: 1, ${f%=*}}]" -f -o short && grep -q "FAIL  ${f##*=}" out ||
    { good=1; sed 's/^/# /' out err; }
done
ok $good "a comparison that gives no number says why"

layers="groups.tank.shapes=[layers: {lower: [0, 0.1 m], upper: [5*H, 3*H], open: [y+]}]"
run 0 "$sphode" run tank2.yml --set "$layers" --set run.end=0.8s -f -o short && grep -q "^liquids  *Mach number up to 0.[3-9][0-9]*, density up to" out &&
  grep -q "^warning  *a liquid was faster than 0.3 of its sound speed" out && grep -q "^warning  *[0-9]* particles are far outside of where everything was at the start, up to [1-9.]* m" out &&
  grep -q '"strayed_particles": [1-9]' short/summary.json && grep -q '"mach_largest": 0.[3-9]' short/summary.json && grep -q "^warning" short/summary.txt
ok $? "what leaves its tank, and what is too fast, is told at the end"
run 0 "$sphode" run tank2.yml --set run.end=0.3s -f -o short && grep -q "^liquids  *Mach number up to 0.1[0-9]*, density up to 0.[0-9]* % off" out && ! grep -q "^warning" out
ok $? "a tank that is right has no warning"

# ---- parameters by --set

good=0
for set in H=0.5 g=1.62 H=1/4 parameters.g=9; do
  run 0 "$sphode" check tank2.yml --set $set && grep -q "^the case  *right" out || { good=1; sed 's/^/# /' err; }
done
run 0 "$sphode" run tank2.yml --set H=0.5 --set run.end=0.01s --set g=1/2 -q -f -o short && grep -q "^  H: 0.5 m$" short/case.yml && run 0 "$sphode" check short/case.yml || good=1
ok $good "a plain number for one with a unit has this unit in SI"

fails "cubic metres" "density: 'm3' is no parameter and no function, nor a table of tables; did you mean m^3?" "groups.water.density=1000 kg/m3"
fails "squared seconds" "'s2' is no parameter .*; did you mean s^2?" "terms.gravity.acceleration=[0, -9.81 m/s2]"
fails "a number too large" "spacing: '1e400' is too large a number" "spacing=1e400 m"
fails "a comma that is missing" "a number right behind another value; between them belongs an operator, in a list a comma" "output.monitors.pressure.at=[5*H 0.1*H]"
fails "points too many" "a number right behind another value" "spacing=1.0.0"

fails "a picture of no field" "field: snapshots will have no 'velocit'; did you mean 'velocity'? they have: position, velocity, density" plot.field=velocit
fails "snapshots too many for a step" "snapshots: 1e-12 s is too short for steps of 0.00[0-9]* s; right is at least" output.snapshots=1e-12
fails "rows too many for a step" "series: 1e-12 s is too short for steps" output.series=1e-12
fails "frames of a probe too many for a step" "interval: 1e-12 s is too short for steps" output.probes.column.interval=1e-12
run 1 "$sphode" run tank2.yml --set plot.field=presure -o unmade && grep -q "field: snapshots will have no 'presure'; did you mean 'pressure'" err && [[ ! -e unmade ]]
ok $? "a run says so before it begins"
sed 's/column: {line.*/column: {at: [100, 0]}/' tank2.yml >place.yml
run 1 "$sphode" check place.yml && grep -q "^sphode: place.yml:52:5: probe column: its places lie" err && run 1 "$sphode" run place.yml -q &&
  grep -q "^sphode: place.yml:52:5: probe column: its places lie" err && ! grep -q checkpoint err
ok $? "what outputs say has its place in the file"
sed 's/lower: \[0, 0\], upper: \[2\*H, H\]/lower: [0, -0.95*dx], upper: [2*H, H]/' tank2.yml >place.yml
run 1 "$sphode" check place.yml && grep -q "^sphode: place.yml:20:3: [0-9]* particles start nearer than 0.1 dx" err
ok $? "and what particles too near say"
sed '/^title:/d' tank2.yml >place.yml
run 0 "$sphode" check place.yml && [[ $(head -1 out) == "water "* ]]
ok $? "a case without a title begins with its groups"

warns() { # what the warning says, --set...
  local says=$1 sets=()
  shift
  for s; do sets+=(--set "$s"); done
  run 0 "$sphode" check tank2.yml "${sets[@]}" && grep -q "^warning  *.*$says" out && return
  sed 's/^/# /' out
  good=1
}
good=0
warns "alpha_min: does nothing without a switch" terms.viscosity-artificial.alpha_min=0.01
warns "water has a viscosity, but there is no viscosity-laminar" "groups.water.viscosity=1 mPa s"
[[ $(grep -c "^warning" out) == 1 ]] || good=1 # once
warns "water has a conductivity, but there is no conduction" "groups.water.conductivity=1"
warns "water: sound speed 1480 m/s is 610 times the largest speed, about 2.43 m/s; .* right is 10 times, 24.3 m/s, with 1/61 of the steps" c=1480
warns "viscosity-laminar bounds steps to 1/7 of h/c" terms.viscosity-laminar= "groups.water.viscosity=500 Pa s"
warns "hydrostatic: nothing holds this pressure: the particles beneath water are 0.115 m (7.67 dx) away" \
  "groups.tank.shapes=[layers: {lower: [0, -0.1 m], upper: [5*H, 3*H], open: [y+]}]"
warns "surface: .* above the top of water, which is at .* m: it will spring up" "groups.water.initial.hydrostatic.surface=H + dx"
warns "surface: .* below the top of water, which is at .* m: it will fall" "groups.water.initial.hydrostatic.surface=H - dx"
warns "heat_flux: does nothing without the term conduction" "groups.tank.boundary={model: mirror, heat_flux: 1 W/m^2}"
warns "wall tank has a temperature, but there is no conduction" "groups.tank.boundary={temperature: 300 K}"
warns "linear: does nothing without an imex: method" integrator.linear=klu
warns "tolerance: does nothing without error control" integrator.tolerance=0.1 integrator.error_control=false
warns "cfl: does nothing without steps that change" integrator.cfl=0.5 "integrator.dt_fixed=0.1 ms"
warns "seed: does nothing without jitter" groups.water.seed=2
warns "repulsion: does nothing without model: adami" "groups.tank.boundary={model: dbc, repulsion: 0.3}"
warns "packing: does nothing without a shape that is filled" groups.tank.packing=
warns "lattice: does nothing without a shape that is filled" groups.tank.lattice=hexagonal
warns "window: it begins at 4 s, behind the end of the run, 1 s" "compare=[{name: a, quantity: front, time_scale: 2 s, window: [2, 3], reference: {csv: {file: front.csv}}}]"
warns "reference: 1 of its 2 points that count are behind the end of the run, 0.05 in their time" run.end=0.05s output.snapshots=0.05s "compare=[{name: a, quantity: front, bar: 1, reference: {csv: {file: front.csv}}}]"
warns "reference: none of its 2 points is in the window and below up_to" "compare=[{name: a, quantity: front, window: [5, 6], time_scale: 0.1s, reference: {csv: {file: front.csv}}}]"
warns "threshold: does nothing without norm: arrival" "compare=[{name: a, quantity: front, norm: mean, threshold: 1, reference: {value: 1}}]"
ok $good "keys that do nothing without their partner"
good=0
warns "time: event a never happens: the run ends at t = 1 s" "events={a: {when: {time: 2 s}}}"
warns "time: event a never happens: the run begins there" "events={a: {when: {time: 0}}}"
warns "direction: event a never happens: time rises" "events={a: {when: {time: 0.5 s}, direction: falling}}"
warns "samples: does nothing without something to search" "events={a: {when: {time: 0.5 s}, samples: 3}}"
warns "event a: its front is 0.6 m when the run begins, above 0.3 m already" "events={a: {when: {front: {at: 0.3 m}}}}"
warns "event a: its point is wet when the run begins" "events={a: {when: {wet: [0.1, 0.1]}}}"
warns "snapshots: 2 s is longer than the run of 1 s" "output.snapshots=2 s"
warns "series: 2 s is longer than the run of 1 s" "output.series=2 s"
warns "interval: 2 s is longer than the run of 1 s" "output.probes={a: {at: [0, 0], interval: 2 s}}"
warns "interval: 3 s is longer than the run of 1 s" "checkpoint.interval=3 s"
ok $good "events that never happen, periods longer than the run"
good=0
warns "snapshots: 1e-07 s makes 1e+07 snapshots in the run of 1 s; a right number is below 10000" output.snapshots=1e-7
warns "the run writes [0-9.]* TB, but [0-9.]* [A-Z]*B are free here; fewer snapshots are right" output.snapshots=1e-8
warns "series: 5e-07 s makes 2e+06 rows of series.csv" output.series=5e-7
warns "interval: 5e-07 s makes 2e+06 frames of the probe" output.probes.column.interval=5e-7
warns "interval: 5e-05 s makes 2e+04 checkpoints" checkpoint.interval=5e-5
ok $good "outputs that fill the disk"
good=0
warns "hydrostatic: there is no gravity among the terms to hold this pressure" "terms.gravity.acceleration=[0, 0]"
warns "hydrostatic: the pressure rises downwards along y, but gravity acts along (9.81, 0, 0)" "terms.gravity.acceleration=[9.81, 0]"
warns "hydrostatic: the pressure rises downwards along y, but gravity acts upwards: 9.81 m/s^2" "terms.gravity.acceleration=[0, 9.81]"
warns "gravity: 9.81 m/s^2, but gravity among the terms is 1.62 m/s^2" "terms.gravity.acceleration=[0, -1.62]"
ok $good "a column that gravity does not hold"
good=0
warns "angle: 30 are radians, 4.77 turns; in degrees right is 30 deg" \
  "groups.water.shapes=[{rotate: {of: {box: {lower: [0.5, 0.2], upper: [0.7, 0.4]}}, angle: 30, about: [0.6, 0.4]}}]"
still="the wall stands still; right"
warns "angle: it does not change with t: $still" "groups.tank.boundary={motion: {rotation: {centre: [0, 0], angle: 30 deg}}}"
warns "displacement: none of them changes with t: $still" "groups.tank.boundary={motion: {displacement: [1 cm, 0]}}"
ok $good "degrees that are radians, and motions that are none"
good=0
warns "p: its place x = 100 m is far outside of all particles, which are from -0.0375 to 1.537 m" "output.monitors.p={type: pressure, at: [100, 0]}"
warns "g: its place x = -50 m is far outside" "output.monitors.g={type: gauge, at: [-50 m, 0]}"
warns "column: its end y = 100 m is far outside" "output.probes.column.line.to=[0, 100]"
warns "a: its point x = 90 m is far outside" "output.probes={a: {points: [{at: [0, 0]}, {at: [90 m, 0]}]}}"
warns "a: its front, at x = 50 m is far outside" "events={a: {when: {front: {at: 50 m}}}}"
warns "b: its point y = 30 m is far outside" "events={b: {when: {wet: [0, 30]}}}"
ok $good "places far outside"
good=0
for right in "output.monitors={p: {type: pressure, at: [2, 1]}, g: {type: gauge, at: [1, 1000]}}" "events={a: {when: {front: {at: 2 m}}}}" "terms.gravity.acceleration=[0, -9.5]" \
  groups.water.jitter=0.3 groups.water.lattice=hexagonal "output.snapshots=1e-4" plot.field=velocity_y plot.field=group "groups.tank.boundary={motion: {rotation: {centre: [0, 0], angle: 1 deg*sin(t/(1 s))}}}" \
  "groups.water.shapes=[{rotate: {of: {box: {lower: [0.5, 0.05], upper: [0.7, 0.25]}}, angle: 390 deg, about: [0.6, 0.15]}}]"; do
  run 0 "$sphode" check tank2.yml --set "$right" && grep -q "right, 0 warnings" out || { good=1; grep warning out; }
done
ok $good "and what is right has none of them"

run 0 "$sphode" run tank2.yml --set output.snapshots=1e-8 --set output.series=1 --set output.probes.column.interval=1 --set checkpoint.keep=0 --set "events={a: {when: {time: 1e-9}, stop: true}}" \
  --set integrator.dt_max=2e-9 -o full && grep -q "^sphode: warning: the run writes [0-9.]* TB of snapshots, or more, but [0-9.]* [A-Z]*B are free in full; fewer are right" err
ok $? "a run says that the disk is too small, too"

# What it says of the files, beside those of the run.
size() { cat "$@" 2>/dev/null | wc -c; }
near() { awk -v a="$1" -v b="$2" -v most="$3" 'BEGIN { e = a / b - 1; exit !(e < most && -e < most) }' || echo "# $1 said, $2 found"; }
run 0 "$sphode" check tank2.yml
read -r snapshots each rows row frames frame checkpoints checkpoint < <(sed -n 's/^output  *\([0-9]*\) snapshots of \([0-9.]*\) kB, \([0-9]*\) rows of \([0-9]*\) B in series.csv, '\
'\([0-9]*\) frames of \([0-9.]*\) kB in probe_column.csv, at most \([0-9]*\) checkpoints of \([0-9.]*\) kB; .* in all$/\1 \2 \3 \4 \5 \6 \7 \8/p' out)
run 0 "$sphode" run tank2.yml -q -o written && set -- written/checkpoint_* && [[ $(ls written/snapshot_*.hdf | wc -l) == "$snapshots" ]] &&
  [[ $(($(wc -l <written/series.csv) - 1)) == "$rows" && $(grep -c '^$' written/probe_column.csv) == "$frames" ]] && (($# <= checkpoints)) &&
  [[ -z $(near "$(awk "BEGIN { print 1000 * $each * $snapshots }")" "$(size written/snapshot_*.hdf written/walls_*.hdf)" 0.15; near "$((row * rows))" "$(size written/series.csv)" 0.15
    near "$(awk "BEGIN { print 1000 * $frame * $frames }")" "$(size written/probe_column.csv)" 0.6; near "$(awk "BEGIN { print 1000 * $checkpoint }")" "$(size "$1")" 0.05) ]]
ok $? "counts and bytes are those that a run writes"
run 0 "$sphode" run tank2.yml --set "run.end=1 ms" --set "groups.water.viscosity=1 mPa s" -o warned && cp err said
run 0 "$sphode" check tank2.yml --set "run.end=1 ms" --set "groups.water.viscosity=1 mPa s"
sed -n 's/^warning  */sphode: warning: /p' out >wanted
grep -q "water has a viscosity, but there is no" wanted && diff wanted <(grep "^sphode: warning: " said) >/dev/null &&
  run 0 "$sphode" run tank2.yml --set "run.end=1 ms" --set "groups.water.viscosity=1 mPa s" -o warned -f -q && [[ ! -s err ]]
ok $? "a run says the warnings of a check, but not with --quiet"
event='events={fill: {when: {front: {at: 4*H}}, snapshot: true, once: true}, turn: {when: {time: 0.5 s}, stop: true, change: {gravity: [0, -1], delta: 0.2, walls: {tank: {velocity: [1, 0]}}}}}'
run 0 "$sphode" check tank2.yml --set "$event" --set 'groups.tank.boundary={motion: {velocity: [0, 0]}}' && grep -q "right, 0 warnings" out &&
  grep -q "^event        fill: the front of all fluids passes x = 1.2 m, once: snapshot$" out &&
  grep -q "^event        turn: t = 0.5 s: gravity (0, -9.81) -> (0, -1), delta 0.1 -> 0.2, velocity of tank -> (1, 0), stop$" out
ok $? "what events wait for, do and change"
run 0 "$sphode" check tank2.yml --set integrator.method=leapfrog && grep -q "^bound by  *cfl [0-9]* %" out &&
  run 0 "$sphode" check tank2.yml --set integrator.dt_max=1e-5 && grep -q "^bound by  *dt_max 100 %$" out &&
  run 0 "$sphode" check tank2.yml --set integrator.dt_fixed=1e-5 && grep -q "^bound by  *dt_fixed 100 %$" out
ok $? "and what bounds the steps"
run 1 "$sphode" check tank2.yml --set "integrator.dt_fixed=5 ms" && grep -q "What helps: a smaller dt_fixed, or none" err
ok $? "fixed steps that fail"
if command -v gnuplot >/dev/null; then
  run 0 "$sphode" check tank2.yml --picture a.png && [[ $(head -c 4 a.png | tail -c 3) == PNG ]] && grep -q "groups\|water" a.gp &&
    [[ $(grep -c '^$' a.dat) == 4 ]]
  ok $? "a picture: a block for each group"
else
  ok 0 "a picture # SKIP no gnuplot"
fi
run 1 "$sphode" check tank2.yml --picture a.pdf && grep -q "^steps " out && grep -q "^the case  *right" out && grep -q "no picture: .*a name like x.png is right" err
ok $? "a picture that cannot be drawn is told behind the report"
[[ -z $(ls "$TMPDIR") ]]
ok $? "nothing is left behind"

# ---- the tutorial

{
  printf 'dimension: 2\nspacing: 2 cm\n'
  sed -n '/^## 3\. /,/^## 4\. /{/^```yaml/,/^```$/{/^```/!p}}' "$SRCDIR/docs/tutorial.md" |
    sed 's/^  \(water\|tank\):$/&\n    density: 1000\n    eos: {tait: {sound_speed: 30}}/'
  printf 'terms: {continuity: , pressure: , gravity: {acceleration: [0, -9.81]}}\nrun: {end: 0.1 s}\n'
} >pillar.yml
run 0 "$sphode" check pillar.yml && grep -q "^the case  *right, 0 warnings" out
ok $? "the tutorial's tank with a pillar fits"

# Each YAML block of section 4 stands in the case, word for word.
whole=$(<"$SRCDIR/cases/piston-hill-3d.yml") good=0 blocks=0 block='' inside=0
while IFS= read -r line; do
  if [[ $line == '```yaml' ]]; then
    inside=1 block=$'\n' blocks=$((blocks + 1))
  elif [[ $inside == 1 && $line == '```' ]]; then
    inside=0
    [[ $whole == *"$block"* ]] || { good=1; echo "# not in the case:$block" | sed '2,$s/^/# /'; }
  elif [[ $inside == 1 ]]; then
    block+=$line$'\n'
  fi
done < <(sed -n '/^## 4\. /,/^## 5\. /p' "$SRCDIR/docs/tutorial.md")
[[ $good == 0 && $blocks -ge 5 ]]
ok $? "what the tutorial shows of its case stands in the case"

# ---- the schema

run 0 "$sphode" schema && cmp out "$SRCDIR/docs/sphode.schema.json"
ok $? "docs/sphode.schema.json is that of the table (sphode schema > docs/sphode.schema.json)"
run 0 "$sphode" schema s.json && cmp s.json "$SRCDIR/docs/sphode.schema.json" && run 1 "$sphode" schema s.json && grep -q "s.json is there already" err
ok $? "into a file, which it does not write over"
if python3 -c 'import jsonschema, yaml' 2>/dev/null; then
  python3 - "$SRCDIR" <<'END'
import glob, json, sys, jsonschema, yaml
root = sys.argv[1]
schema = json.load(open(root + "/docs/sphode.schema.json"))
validator = jsonschema.validators.validator_for(schema)
validator.check_schema(schema)
v, bad = validator(schema), 0
for name in sorted(glob.glob(root + "/cases/*.yml") + glob.glob(root + "/prog/templates/*.yml")):
    for e in v.iter_errors(yaml.safe_load(open(name))):
        print("#", name, list(e.absolute_path), e.message[:200]); bad += 1
wrong = 0
base = yaml.safe_load(open(root + "/prog/templates/tank.yml"))
for change in ({"spacng": 1}, {"dimension": 4}, {"search": "gird"}, {"run": {}}, {"periodic": {"axes": "x"}},
               {"groups": {"w": {"kind": "fluid", "shapes": [{"box": {}, "ball": {}}]}}}, {"output": {"compression": 10}},
               {"compare": [{"name": "a", "quantity": "b", "reference": {}}]}):
    found = any(v.iter_errors({**base, **change})); wrong += found
    if not found: print("# taken:", change)
for key in ("dimension", "spacing", "groups", "terms", "run"):
    without = {k: x for k, x in base.items() if k != key}
    wrong += any(v.iter_errors(without)) and not any(v.iter_errors({**without, "include": "a.yml"}))
sys.exit(bad or wrong != 13)
END
  ok $? "all cases are right by it, and what is wrong is not"
else
  ok 0 "all cases are right by it # SKIP no python3 with jsonschema and yaml"
fi

# ---- which fields snapshots hold

chosen() { sed -e "s/^output:/output:\n  fields: $1/" -e '/^plot:/,$d' "$SRCDIR/cases/dam-break-2d.yml" >chosen.yml; } # FIELDS: without picture, comparisons
chosen "pressure velocty"
run 1 "$sphode" check chosen.yml && grep -q "chosen.yml:[0-9]*:11: fields: no group has a field \"velocty\"; did you mean 'velocity'" err &&
  run 1 "$sphode" run chosen.yml -o chosen && grep -q "chosen.yml:[0-9]*:11: fields: .*velocty" err && [[ ! -e chosen/snapshot_0000.hdf ]]
ok $? "output: fields names one that there is not"
chosen "pressure, sound_speed"
run 0 "$sphode" run chosen.yml -o chosen --set run.end=T/100 --set parameters.dx=H/10 --force && run 0 "$sphode" export chosen --csv &&
  [[ $(head -1 chosen/csv/snapshot_0000.csv | tr -d '"' | sed 's/ \[[^]]*\]//g') == x,y,density,group,id,mass,pressure,smoothing_length,sound_speed ]] &&
  run 1 "$sphode" plot chosen --field velocity && grep -q 'no field "velocity"; it has: .*sound_speed' err
ok $? "snapshots hold them and no others"
printf 'plot:\n  field: velocity_x\n' >>chosen.yml
run 1 "$sphode" check chosen.yml && grep -q "chosen.yml:[0-9]*:10: field: snapshots will have no 'velocity_x'" err
ok $? "nor can a picture show others"
sed -e 's/^output:/output:\n  fields: pressure/' -e 's/^  field: .*/  field: pressure/' "$SRCDIR/cases/taylor-green-2d.yml" >chosen.yml
grep -q "    at: " chosen.yml && run 1 "$sphode" check chosen.yml && grep -q "chosen.yml:[0-9]*:[0-9]*: quantity: snapshots will hold no velocity, which is compared with them" err
ok $? "nor what is compared with snapshots"

# ---- sweeps

small=(--set run.end=0.01s)
run 1 "$sphode" sweep channel.yml --vary dx=L/10,L/4,L/20 --jobs 2 "${small[@]}" && grep -q "^dx=L_4  *failed" out &&
  grep -q "1 of 3 runs failed" err && [[ -s channel-sweep/dx=L_10/summary.json && -s channel-sweep/dx=L_20/summary.json ]] &&
  grep -q "periodic" channel-sweep/dx=L_4.log
ok $? "a run that fails is told, and the others are kept"
# The order is that of the distances in their own summaries.
value() { sed -n 's/^ *"value": \([^,]*\),*$/\1/p' "channel-sweep/$1/summary.json" | head -1; }
awk -F, -v a="$(value dx=L_10)" -v b="$(value dx=L_20)" '
  NR == 1 { if ($0 != "run,dx,status,spacing [m],particles,steps,wall [s],velocity at the end (rms),order 0") bad = 1; next }
  { n++; if ($3 != ($1 == "dx=L_4")) bad = 1 }
  $1 == "dx=L_10" { e = $8 / a - 1; if (e * e > 1e-12 || $4 != 0.0001 || $5 != 100) bad = 1 }
  $1 == "dx=L_20" { p = log(b / a) / log(0.5); e = $9 - p; if (e * e > 1e-5 || $8 == "nan") bad = 1 }
  END { exit bad || n != 3 }' channel-sweep/sweep.csv || { sed 's/^/# /' channel-sweep/sweep.csv; false; }
ok $? "sweep.csv holds distances and their order"
awk -F, 'NR == 1 { if ($0 != "spacing [m],velocity at the end (rms),order 1,order 2") bad = 1; next }
  NR == 2 { e = $2; if ($3 != e || $4 != e) bad = 1 }
  NR == 3 { if (($3 - e / 2)^2 > 1e-16 * e^2 || ($4 - e / 4)^2 > 1e-16 * e^2) bad = 1 }
  END { exit bad || NR != 3 }' channel-sweep/convergence.csv || { sed 's/^/# /' channel-sweep/convergence.csv; false; }
ok $? "convergence.csv names its columns, and has two slopes beside them"
if command -v gnuplot >/dev/null; then [[ -s channel-sweep/convergence.png ]]; ok $? "its picture"; else ok 0 "its picture # SKIP no gnuplot"; fi
before=$(cksum channel-sweep/dx=L_20/* channel-sweep/dx=L_20.log)
run 0 "$sphode" sweep channel.yml --vary dx=L/10,L/20 "${small[@]}" && [[ $(grep -c "done before" err) == 2 && $(grep -c "done" out) == 2 ]] &&
  [[ $before == "$(cksum channel-sweep/dx=L_20/* channel-sweep/dx=L_20.log)" ]] && awk -F, '$8 == "nan"' channel-sweep/sweep.csv | wc -l | grep -qx 0
ok $? "runs that are done are kept"
run 1 "$sphode" sweep channel.yml --vary dx=L/20,L/40 --set run.end=0.02s && [[ $before == "$(cksum channel-sweep/dx=L_20/* channel-sweep/dx=L_20.log)" ]] &&
  grep -q "channel-sweep/dx=L_20/case.yml is not the case of this sweep; .*--force" err && [[ ! -e channel-sweep/dx=L_40 ]]
ok $? "a sweep of another case is not written over"
run 3 "$sphode" sweep channel.yml --vary dx=L/10 --vary "terms.gravity.acceleration=[F,0],[2*F,0]" "${small[@]}" -o two -q &&
  [[ ! -s out && -d two/dx=L_10,terms.gravity.acceleration=_F_0_ && $(wc -l <two/sweep.csv) == 3 ]]
ok $? "all combinations; commas in brackets are of a value; a missed bar is exit status 3"
run 1 "$sphode" sweep channel.yml --vary dx=1cm,1s -o three && grep -q "spacing: found s, wanted m" err && [[ ! -e three ]]
ok $? "a value that is wrong is told before any run"
# Stopped where the second of three runs is on its way; then the same command.  What it leaves is that of a sweep without this.
three=(sweep channel.yml --vary dx=L/10,L/20,L/21 --set run.end=6s --set output.series=10ms --set output.snapshots=1s --lenient)
stop() { # NAME SIGNAL STATUS WHOM OPTION...: - before the process: its group is told
  local name=$1 signal=$2 status=$3 whom=$4 tries=0 at=0.02
  setsid "$sphode" "${three[@]}" -o "$name" "${@:5}" >out 2>err &
  local job=$!
  until [[ $(wc -l 2>/dev/null <"$name/dx=L_20/series.csv") -gt 12 || $((tries++)) -gt 3000 ]]; do sleep $at; done 2>/dev/null
  kill -s "$signal" -- "$whom$job"
  wait $job
  [[ $? == "$status" ]] && ls "$name"/dx=L_20/checkpoint_*.hdf >found && grep -q "^dx=L_20  *stopped" out && grep -q "^dx=L_20: stopped" err &&
    grep -q '"error": "stopped on request' "$name/dx=L_20/summary.json" && grep -q "$name: stopped; the same command goes on" err && ! grep -q failed out err && grep -q "^dx=L_20,L/20,$status," "$name/sweep.csv" ||
    { sed 's/^/# /' out err; false; }
}
again() { # NAME: goes on, and leaves what `straight` has
  local file
  run 0 "$sphode" "${three[@]}" -o "$1" || return 1
  for file in straight/dx=*/*.hdf straight/dx=*/*.series straight/dx=*/series.csv; do
    [[ $file == */checkpoint_* ]] && continue
    if [[ $file == */snapshot_* ]]; then [[ -s ${file/straight/$1} ]]; else cmp "$file" "${file/straight/$1}"; fi || return 1
  done
  cut -d, -f1-6,8- straight/sweep.csv | cmp - <(cut -d, -f1-6,8- "$1/sweep.csv")
}
run 0 "$sphode" "${three[@]}" -o straight -q && stop term TERM 143 "" && grep -q "^dx=L_10  *done" out && grep -q "^dx=L_21  *not run" out &&
  before=$(cksum term/dx=L_10/*)
ok $? "SIGTERM stops a sweep behind a checkpoint of its run"
again term && [[ $before == "$(cksum term/dx=L_10/*)" ]] && grep -q "^dx=L_10: done before" err && grep -q "going on from" term/dx=L_20.log
ok $? "the same command keeps what was done, goes on with what was stopped, and begins the rest"
stop group INT 130 - && again group
ok $? "SIGINT to all of its processes, as by Ctrl-C, which its runs hear twice"
stop two TERM 143 "" --jobs 2 && again two
ok $? "two runs at a time"

good=0
for bad in dx dx= =1 dx=1,,2; do run 2 "$sphode" sweep channel.yml --vary $bad && grep -q "^sphode: .*--vary $bad" err || good=1; done
run 2 "$sphode" sweep channel.yml && grep -q "sweep wants --vary" err || good=1
ok $good "bad --vary"
echo 1..$count
