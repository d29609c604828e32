#!/usr/bin/env bash
# sphode restart where not all is as it was: particles that left a probe, tables that were lost, --set of what a restart can and
# cannot change, ends that are passed, signals that come twice.
source "$SRCDIR/tests/tap.sh"
cat >block.yml <<'END'
dimension: 2
parameters: {H: 0.3 m, alpha: 0.1, length: H}
spacing: 3 cm
groups:
  water:
    kind: fluid
    density: 1000 kg/m^3
    viscosity: 0.01 Pa s
    eos: {linear: {sound_speed: 50 m/s}}
    initial: {velocity: [5 m/s, 0 m/s]}
    shapes: [box: {lower: [0, 0], upper: [length, H]}]
terms:
  continuity:
  pressure:
  viscosity-artificial: {alpha: alpha}
run: {end: 0.3 s}
output:
  snapshots: 0.1 s
  series: 10 ms
  probes:
    p: {at: [0.1 m, 0.1 m]}
    column: {line: {from: [0.1 m, 0], to: [0.1 m, 0.3 m], n: 3}}
checkpoint: {steps: 100}
END
newest() { ls "$1"/checkpoint_*.hdf | tail -n 1; }

# ---- probes

run 0 "$sphode" run block.yml -q -o whole && grep -q "^0.3,0.1,0.1,0,nan" whole/probe_p.csv && [[ -n $(newest whole) ]]
ok $? "particles leave the places of a probe: the run goes on, behind checkpoints"
run 0 "$sphode" run block.yml -q -o first --set run.end=0.2s && run 0 "$sphode" restart first -q --until 0.3s &&
  cmp <(head -n 20 first/probe_p.csv) <(head -n 20 whole/probe_p.csv) && grep -q "^0.3,0.1,0.1,0,nan" first/probe_p.csv
ok $? "and is gone on with"
run 1 "$sphode" run block.yml -q -o far --set "output.probes.p.at=[9 m, 0.1 m]" && grep -q "probe p: its places lie between x = 9 and 9 m" err
ok $? "a place far outside is refused at the start"

# ---- tables that were lost

lost() { # NAME, what is told, command in the results
  rm -rf hurt
  cp -r first hurt
  (cd hurt && eval "$3")
  run 0 "$sphode" restart hurt -q --until 0.3s && grep -q "warning: $2" err
  ok $? "$1"
}
rm -rf first
run 0 "$sphode" run block.yml -q -o first --set run.end=0.2s
lost "a table that is gone begins anew" "hurt/series.csv is gone or empty: it begins anew" "rm series.csv" &&
  [[ $(head -n 1 hurt/series.csv) == "$(head -n 1 whole/series.csv)" && $(sed -n 2p hurt/series.csv) == 0.21,* && $(tail -n 1 hurt/series.csv) == 0.3,* ]]
ok $? "with its header, up to the end"
lost "one that is cut short goes on" "hurt/series.csv has [0-9]* bytes, had [0-9]* then: rows are missing, it goes on from there" \
  'truncate -s -100 series.csv'
[[ $(awk -F, '{print NF}' hurt/series.csv | sort -u | wc -l) == 1 && $(wc -l <hurt/series.csv) -ge 29 ]]
ok $? "behind its last whole row"
lost "of a line of probes" "hurt/probe_column.csv has" 'truncate -s -100 probe_column.csv' &&
  [[ $(awk -v RS= '{print NF}' hurt/probe_column.csv | tail -n +2 | sort -u | wc -l) == 1 ]]
ok $? "behind its last whole frame"
lost "snapshots that are gone" "1 of [0-9]* snapshots of hurt are gone" 'rm snapshot_0001.hdf'
! grep -q snapshot_0001 hurt/snapshot.hdf.series && grep -q snapshot_0002 hurt/snapshot.hdf.series
ok $? "are not listed any more"
mkdir bare && cp "$(newest first)" bare
run 0 "$sphode" restart bare -q --until 0.3s && cmp <(tail -n 5 bare/series.csv) <(tail -n 5 hurt/series.csv)
ok $? "a checkpoint alone, elsewhere, is enough"

# ---- what is set

refused() { # KEY=VALUE, the key that is told
  run 1 "$sphode" restart first -q --until 0.3s --set "$1" && grep -q "first: --set ${1%%=*}=.*: $2 (.*) cannot change where a run goes on; what can:" err
  ok $? "--set $1 is refused"
}
taken() { # KEY=VALUE
  rm -rf hurt
  cp -r first hurt
  run 0 "$sphode" restart hurt -q --until 0.22s --set "$1"
  ok $? "--set $1 is taken"
}
refused groups.water.density=500 groups.water.density
refused H=0.31m groups.water.shapes.0.box.upper.0
refused spacing=2.5cm spacing
refused terms.xsph.epsilon=0.1 terms.xsph
refused output.probes.column.line.n=5 output.probes.column.line.n
refused "output.monitors.front={type: front}" output.monitors
refused kernel.name=wendland-c6 kernel.name
refused "groups.water.eos.linear.sound_speed=40 m/s" groups.water.eos.linear.sound_speed
refused terms.viscosity-artificial.switch=balsara terms.viscosity-artificial.switch
refused "groups.water.initial.velocity=[1 m/s, 0 m/s]" groups.water.initial.velocity.0
run 1 "$sphode" restart first -q --set run.end=0.3s --set spacing=2.5cm && grep -q -- "--set spacing=2.5cm: spacing (it was 3 cm, is 2.5cm)" err &&
  ! grep -q "sphode run" err
ok $? "the one of several that cannot be taken is named, and no run is thrown away"
for set in alpha=0.2 terms.viscosity-artificial.alpha=0.2 terms.viscosity-artificial.beta=1 "H=300 mm" run.time_limit=1h integrator.cfl=0.2 \
  integrator.method=leapfrog "output.series=5 ms" "output.probes.p.interval=5 ms" "groups.water.viscosity=0.02 Pa s" checkpoint.steps=7 \
  "output.probes.q={at: [1 m, 0.1 m]}" "events.late={when: {time: 0.21 s}}" density_reset.every=20 "speed=5 m/s" \
  "title=another" plot.field=pressure; do
  taken "$set"
done

# ... and has an effect: each is seen in what the restart writes.
effect() { # NAME KEY=VALUE CONDITION: on hurt/, beside same/, which nothing was set in
  rm -rf hurt
  cp -r sheared hurt
  run 0 "$sphode" restart hurt --until 0.22s --set "$2" && eval "$3"
  ok $? "$1 takes effect: $2"
}
run 0 "$sphode" run block.yml -q -o sheared --set run.end=0.2s --set "groups.water.initial.velocity=[5 m/s + 3/s*y, 0 m/s]" \
  --set "terms.viscosity-laminar={}" && cp -r sheared same &&
  run 0 "$sphode" restart same -q --until 0.22s
ok $? "a block that is sheared"
last() { tail -n 1 "$1/series.csv" | cut -d, -f"$2"; } # DIR COLUMN
column=$(head -n 1 same/series.csv | tr , '\n' | grep -n "^kinetic" | cut -d: -f1)
less() { awk -v a="$(last hurt "$column")" -v b="$(last same "$column")" 'BEGIN { exit !(a < b * (1 - 1e-9) && a > 0.9 * b) }'; }
effect "artificial viscosity" terms.viscosity-artificial.alpha=0.4 less
effect "a parameter behind it" alpha=0.4 less
effect "a viscosity" "groups.water.viscosity=5 Pa s" less
effect "the steps" integrator.cfl=0.1 '(($(last hurt 2) > $(last same 2) + 5))'
effect "the integrator" integrator.method=leapfrog 'grep -q leapfrog hurt/summary.json && ! grep -q leapfrog same/summary.json'
effect "an interval of series" "output.series=5 ms" '[[ $(awk -F, "NR > 1 && \$1 > 0.2001 { print \$1 }" hurt/series.csv | tr "\n" " ") == "0.205 0.21 0.215 0.22 " ]]'
effect "an interval of a probe" "output.probes.p.interval=5 ms" '[[ $(awk -F, "NR > 1 && \$1 > 0.2001" hurt/probe_p.csv | wc -l) == 4 && $(awk -F, "NR > 1 && \$1 > 0.2001" same/probe_p.csv | wc -l) == 2 ]]'
seventh() { ls "$1" | sed -n 's/^checkpoint_0*\([0-9]*\).hdf/\1/p' | awk '$1 % 7 == 0 { found = 1 } END { exit !found }'; }
effect "checkpoints" checkpoint.steps=7 'seventh hurt && ! seventh same'
effect "a new probe" "output.probes.q={at: [1 m, 0.1 m]}" '[[ $(awk -F, "\$2 == 1" hurt/probe_q.csv | wc -l) -ge 2 ]]'
effect "an event" "events.late={when: {time: 0.21 s}}" 'grep -q "^0.2[01][0-9]*,[0-9]*,late" hurt/events.csv'
effect "the title" title=another 'head -n 1 out | grep -qx another'
effect "the picture" plot.field=pressure 'grep -q "^set cblabel .pressure" hurt/frames.gp'

run 1 "$sphode" restart first -q --until 0.1s && grep -q -- "--until 0.1s: the run came to t = 0.2 s (first/checkpoint_.*); right is a later time, as --until 0.4s" err
ok $? "--until a time that is over"

# ---- a source that ends

sed '/^  pressure:/a\  body-force: {acceleration: [0 m/s^2, "1 m/s^2*sqrt(0.3 - t/(0.1 s))"]}' block.yml >root.yml
run 1 "$sphode" run root.yml -o root -q &&
  grep -q "root.yml:15:41: body-force: acceleration '1 m/s^2\*sqrt(0.3 - t/(0.1 s))' is nan at t = 0.03[0-9]* s, x = .* m, y = .* m (water); right is one that is finite" err && ! grep -q "What helps" err &&
  [[ -s root/failure.csv ]]
ok $? "an acceleration that becomes not a number is told with its place, and leaves a failure.csv"

sed '/^terms:/i\  piston:\n    kind: wall\n    density: 1000 kg/m^3\n    shapes: [box: {lower: [-9 cm, 0], upper: [0, H]}]\n    boundary:\n      motion: {displacement: [0 m, 1 cm*sqrt(1 - t/(20 ms))]}' block.yml >wall.yml
run 1 "$sphode" run wall.yml -o wall -q &&
  grep -q "wall.yml:17:36: motion: displacement '1 cm\*sqrt(1 - t/(20 ms))' has no finite value, velocity or acceleration at t = 0.0[12][0-9]* s (wall piston); right is one that is finite" err &&
  [[ -s wall/failure.csv ]]
ok $? "a motion that becomes not a number is told with its place, and leaves a failure.csv"
rm -rf hurt && cp -r first hurt
run 1 "$sphode" restart hurt -q --until 0.3s --set "output.probes.q={at: [9 m, 0.1 m]}" && grep -q "probe q: its places" err && cmp first/case.yml hurt/case.yml
ok $? "a restart that does not begin leaves case.yml as it was"

# ---- scalars

cat >salt.yml <<'END'
include: block.yml
scalars:
  salt: {diffusivity: 0.01 m^2/s, initial: x/(1 m), source: "-0.5 1/s*salt*speed/(1 m/s)"}
END
run 0 "$sphode" run salt.yml -o whole-salt -q --set run.end=0.2s --set checkpoint.steps=20 --set checkpoint.keep=3 &&
  cp -r whole-salt salt && rm "$(newest salt)" && run 0 "$sphode" restart salt -q &&
  cmp salt/series.csv whole-salt/series.csv && grep -q salt_mean salt/series.csv
ok $? "a scalar goes on with the same bits"
run 0 "$sphode" restart salt -q --until 0.22s --set scalars.salt.diffusivity=0.02 &&
  run 1 "$sphode" restart salt -q --until 0.24s --set "scalars.salt.initial=2" && grep -q "scalars.salt.initial (.*) cannot change" err
ok $? "its diffusivity may change, its start not"
sed 's/source: .*/source: "sqrt(0.1 - t\/(1 s))"}/' salt.yml >nan.yml
run 1 "$sphode" run nan.yml -o salt-nan -q &&
  grep -q "nan.yml:3:[0-9]*: salt: source 'sqrt(0.1 - t/(1 s))' is nan at t = 0.1" err
ok $? "a source that becomes not a number is told with its place"

# ---- signals

stopped() { # SIGNAL, exit status: sent three times within a step
  local job tries=0 status
  rm -rf long
  "$sphode" run block.yml -q -o long --set run.end=100s --set spacing=1.5mm --set checkpoint.steps=100000 2>err >out &
  job=$!
  until [[ $(wc -l 2>/dev/null <long/series.csv) -gt 1 || $((tries++)) -gt 6000 ]]; do sleep 0.01; done 2>/dev/null
  kill -"$1" $job
  sleep 0.01 # less than a step takes, else they come as one
  kill -"$1" $job 2>/dev/null
  sleep 0.01
  kill -"$1" $job 2>/dev/null
  wait $job
  status=$?
  [[ $status == "$2" && -n $(newest long) ]] && run 1 "$sphode" restart long -q --until 1us && grep -q "right is a later time" err
  ok $? "$1, three times within a step: behind a checkpoint"
}
set -m # else SIGINT is ignored in the background
stopped TERM 143
stopped INT 130
set +m
mkdir bin && printf '#!/bin/sh\ntouch %s/drawing\nexec sleep 5\n' "$PWD" >bin/gnuplot && chmod +x bin/gnuplot
PATH=$PWD/bin:$PATH "$sphode" run block.yml -o drawn >out 2>err &
job=$! tries=0
until [[ -e drawing || $((tries++)) -gt 1000 ]]; do sleep 0.01; done
kill -TERM $job
wait $job 2>/dev/null
[[ $? == 143 && -s drawn/summary.json ]]
ok $? "once all is written, a signal ends the drawing of pictures"

echo 1..$count
