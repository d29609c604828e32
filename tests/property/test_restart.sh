#!/usr/bin/env bash
# sphode restart: killed at random moments, stopped, out of time, out of space, damaged: the run that goes on leaves the
# files of the one that was never interrupted, byte for byte.
source "$SRCDIR/tests/tap.sh"
every=20 # steps between checkpoints
kills=20
[[ -z $SPHODE_TEST_QUICK ]] || kills=4 # under sanitizers
[[ -z $SPHODE_TEST_LONG ]] || kills=200
RANDOM=${SPHODE_TEST_SEED:-$$}
sed '/^compare:/,$d' "$SRCDIR/cases/dam-break-2d.yml" >dam.yml
# Snapshots hold the command line: each run is in a directory of its own, and writes to out there.
case=(../dam.yml -o out --set "parameters.dx=H/20" --set "run.end=6*T" --set "output.snapshots=T/3" --set "output.series=T/40"
  --set "checkpoint.steps=$every" -q)

# run STATUS DIR COMMAND...: there; standard output to out, errors to err; true where it exits with STATUS.
run() {
  local wanted=$1 dir=$2 status
  shift 2
  mkdir -p "$dir"
  (cd "$dir" && exec "$@") >out 2>err
  status=$?
  [[ $status == "$wanted" ]] && return
  echo "# exit status $status, wanted $wanted: $*"
  sed 's/^/# /' out err
  return 1
}
results() { (cd "$1/out" && ls -- snapshot_* walls_* ./*.series series.csv); }
series() { # DIR: all time series as in whole
  local file
  [[ $(results whole) == "$(results "$1")" ]] || { echo "# $1 has other files"; return 1; }
  for file in snapshot.hdf.series walls.hdf.series series.csv; do cmp "whole/out/$file" "$1/out/$file" || return 1; done
}
same() { # DIR: all results
  local file
  series "$1" || return 1
  for file in $(results whole); do cmp "whole/out/$file" "$1/out/$file" || return 1; done
}
last_step() { tail -n 1 "$1/out/series.csv" 2>/dev/null | cut -d, -f2; }
newest() { ls "$1"/out/checkpoint_*.hdf 2>/dev/null | tail -n 1; }
step_of() { local name=${1##*_}; name=${name%.hdf}; echo $((10#$name)); }

start=${EPOCHREALTIME/[.,]/}
run 0 whole "$sphode" run "${case[@]}" && [[ -n $(newest whole) ]]
ok $? "a run without interruption"
length=$(((${EPOCHREALTIME/[.,]/} - start) / 1000)) # ms
run 0 none "$sphode" run "${case[@]}" --set checkpoint.keep=0 && [[ -z $(newest none) ]] && series none
ok $? "checkpoints change nothing"

# ---- kill -9

# Lives of random length, up to that of a run, until it is done; then another one, until there were enough kills.
lost=0 killed=0 runs=0 resumed=0 bad=0
while ((killed < kills && bad == 0)); do
  dir=kill$((runs++)) over=0
  mkdir $dir
  while ((!over)); do
    cd $dir || exit 99
    if [[ -n $(cd .. && newest $dir) ]]; then
      "$sphode" restart out -q >../out 2>../err &
      resumed=$((resumed + 1))
    else
      "$sphode" run "${case[@]}" >../out 2>../err &
    fi
    job=$!
    cd ..
    if ((killed < kills)); then
      life=$((RANDOM % length))
      sleep "$((life / 1000)).$(printf %03d $((life % 1000)))"
      kill -9 $job 2>/dev/null && killed=$((killed + 1))
    fi
    wait $job 2>/dev/null
    status=$?
    ((status == 0)) && over=1
    if ((status == 1)) && grep -q "its end is" err; then # it was killed behind its summary, while it drew
      status=0 over=1
    fi
    if ((status != 0 && status != 137)); then
      sed 's/^/# /' err
      bad=1 over=1
    fi
    # At most one interval lies behind the newest checkpoint.
    if [[ -n $(newest $dir) && $(last_step $dir) =~ ^[0-9]+$ ]]; then
      behind=$(($(last_step $dir) - $(step_of "$(newest $dir)")))
      ((behind > lost)) && lost=$behind
    fi
  done
  ((bad)) || same $dir || bad=1
  ((bad)) || rm -rf $dir
done 2>/dev/null
echo "# $killed kills in $runs runs, which went on $resumed times from a checkpoint; at most $lost steps were made again"
((resumed > 0 || kills < 20)) || bad=1
ok $bad "kill -9 at $kills random moments: all files as without"
((lost <= every))
ok $? "and never more than an interval was lost"

# ---- stopped

mkdir term
(cd term && exec "$sphode" run "${case[@]}" 2>/dev/null) &
job=$!
tries=0
until [[ $(wc -l 2>/dev/null <term/out/series.csv) -gt 60 || $((tries++)) -gt 6000 ]]; do sleep 0.01; done 2>/dev/null
run 1 term "$sphode" restart out && grep -q "another run is writing to out" err
ok $? "a directory in use is refused"
kill -TERM $job
wait $job
[[ $? == 143 && $(step_of "$(newest term)") -ge $(last_step term) && $(step_of "$(newest term)") -lt 390 ]]
ok $? "SIGTERM ends a run behind a checkpoint"
cp -r term base
rm term/out/summary.json
run 1 term "$sphode" run "${case[@]}" && grep -q "holds a run that was interrupted; sphode restart out goes on" err
ok $? "and what can go on is not written over"
for dir in set until other; do cp -r term $dir; done
run 0 term "$sphode" restart out -q --threads 2 && same term
ok $? "it goes on with two threads"
run 1 term "$sphode" restart out -q && grep -q "its end is .*--until TIME" err
ok $? "a run at its end says so"
rm term/out/summary.json
run 0 term "$sphode" restart out -q && [[ -s term/out/summary.json ]] && same term
ok $? "one that was killed there is concluded"
run 0 until "$sphode" restart out -q --until 0.25s && tail -n 1 until/out/series.csv | grep -q "^0.2[45]" &&
  cmp <(head -n 150 whole/out/series.csv) <(head -n 150 until/out/series.csv)
ok $? "--until another time"
run 0 set "$sphode" restart out -q --set "output.snapshots=T/6" --set terms.viscosity-artificial.alpha=0.2 &&
  [[ $(ls set/out/snapshot_* | wc -l) -gt $(ls whole/out/snapshot_* | wc -l) ]] && ! cmp -s set/out/series.csv whole/out/series.csv &&
  grep -q "alpha=0.2" set/out/case.yml
ok $? "--set changes what follows"
run 1 other "$sphode" restart out --set spacing=1cm -q && grep -q "out: --set spacing=1cm: .* cannot change where a run goes on; what can: run" err
ok $? "and refuses what makes another simulation"
# However slow the machine, each life makes a step.
run 4 limit "$sphode" run "${case[@]}" --set run.time_limit=0.1s
status=$? lives=1
grep -q "stopped before run.time_limit is over at t = " limit/out/summary.json
limited=$?
until [[ $status != 0 || $lives == 400 ]]; do
  (cd limit && exec "$sphode" restart out -q >../out 2>../err)
  status=$(($? - 4)) lives=$((lives + 1))
done
[[ $status == -4 && $limited == 0 ]] && series limit
ok $? "a time limit stops it in time, with exit status 4, and it goes on"

# A queue that tells its end in the environment is like a time limit, which leaves a minute for what is behind the last step.
run 4 queue env SLURM_JOB_END_TIME=$(($(date +%s) + 61)) "$sphode" run "${case[@]}" --set "run.end=6000*T" && [[ -n $(newest queue) ]]
ok $? "a run stops before its queue ends the job, behind a checkpoint"
run 4 queue env SLURM_JOB_END_TIME=$(($(date +%s) + 10)) "$sphode" restart out -q && grep -q "goes on from" err
ok $? "one that starts in its last minute makes a step, and stops"
run 0 never env SLURM_JOB_END_TIME=never "$sphode" run "${case[@]}" && series never
ok $? "an end that is no number is none"

# ---- moved

mkdir -p moved/old
sed 's/^spacing:/tables:\n  push: {file: push.csv}\nspacing:/
  s/^  gravity: .*/&\n  body-force: {acceleration: [push, 0 m\/s^2]}/' dam.yml >moved/old/push.yml
printf 't [s],a [m/s^2]\n0,0\n0.1,1\n1,0\n' >moved/old/push.csv
short=(--set "parameters.dx=H/20" --set "run.end=2*T" --set "checkpoint.steps=$every" -q)
run 0 moved "$sphode" run old/push.yml -o out "${short[@]}" && cp moved/out/series.csv moved/whole.csv &&
  cmp moved/old/push.csv moved/out/files/push.csv
ok $? "results keep the files that the case names"
mv moved/out moved/elsewhere && rm -r moved/old moved/elsewhere/summary.json && rm -- "$(ls moved/elsewhere/checkpoint_* | tail -n 1)"
run 0 moved "$sphode" restart elsewhere -q && cmp moved/whole.csv moved/elsewhere/series.csv
ok $? "a run goes on where the case and its files are gone, and the results elsewhere"
run 0 moved "$sphode" run elsewhere/case.yml -o again -q && cmp moved/whole.csv moved/again/series.csv
ok $? "and can be run again from what it kept"

# ---- walls that turn and warm by tables

# All that follows the time of the run is worked out again, none of it is kept: so it must come out the same.
mkdir -p turned
cat >turned/mixer.yml <<'END'
dimension: 2
parameters: {w: 8 1/s}
spacing: 2 cm
tables:
  angle: {file: angle.csv}
  warm: {file: warm.csv, outside: repeat}
groups:
  water:
    kind: fluid
    density: 1000 kg/m^3
    eos: {linear: {sound_speed: 8 m/s}}
    viscosity: 0.1 Pa s
    conductivity: 50 W/m/K
    specific_heat: 100 J/kg/K
    energy: temperature
    initial: {temperature: 300 K}
    shapes:
      - difference:
          - box: {lower: [0, 0], upper: [0.4 m, 0.4 m]}
          - box: {lower: [0.12 m, 0.18 m], upper: [0.28 m, 0.22 m]}
  stirrer:
    kind: wall
    density: 1000 kg/m^3
    shapes: [box: {lower: [0.12 m, 0.18 m], upper: [0.28 m, 0.22 m]}]
    boundary: {no_slip: true, temperature: 300 K + warm, motion: {rotation: {centre: [0.2 m, 0.2 m], angle: angle}}}
  drum:
    kind: wall
    density: 1000 kg/m^3
    shapes: [layers: {lower: [0, 0], upper: [0.4 m, 0.4 m]}]
    boundary:
      no_slip: true
      temperature: 300 K + 5 K/m*x*sin(w*t)
      motion: {displacement: [1 cm*sin(w*t), 0 m]}
terms:
  continuity:
  pressure:
  viscosity-laminar:
  conduction:
  delta: {delta: 0.1}
  body-force: {acceleration: [0 m/s^2, -1 m/s^2*(1 + warm/(9 K))]}
run: {end: 0.25 s}
output: {snapshots: 0.05 s, series: 5 ms, forces: {stirrer: {about: [0.2 m, 0.2 m]}}}
checkpoint: {steps: 20, keep: 100}
END
printf 't [s],a\n0,0\n0.1,0.2\n0.2,0.9\n0.3,1\n' >turned/angle.csv
printf 't [ms],T [K]\n0,0\n30,4\n60,9\n90,0\n' >turned/warm.csv
mkdir turned/whole turned/part
run 0 turned/whole "$sphode" run ../mixer.yml -o out -q && run 0 turned/part "$sphode" run ../mixer.yml -o out -q &&
  [[ $(ls turned/part/out/checkpoint_* | wc -l) -gt 4 ]]
ok $? "a stirrer and a drum that follow tables"
bad=0
for lost in 1 3; do # from the last but one, and from two before that
  for ((k = 0; k < lost; k++)); do rm -- "$(newest turned/part)"; done
  rm -f turned/part/out/summary.json
  run 0 turned/part "$sphode" restart out -q --threads "$lost" || bad=1
  for file in $(cd turned/whole/out && ls -- snapshot_* walls_* ./*.series series.csv); do
    cmp "turned/whole/out/$file" "turned/part/out/$file" || bad=1
  done
done
grep -q "stirrer_torque" turned/whole/out/series.csv || bad=1
ok $bad "go on with the same bits from any of its checkpoints"

# ---- damaged

[[ $(ls base/out/checkpoint_* | wc -l) == 2 ]]
ok $? "two checkpoints stay"
damaged() { # name, what it says, command
  rm -rf hurt
  cp -r base hurt
  file=$(newest hurt)
  eval "$3"
  run 0 hurt "$sphode" restart out -q && grep -q "$(basename "$file"): .*$2" err
  ok $? "$1: the one before is used"
}
damaged "a damaged byte" "its checksum is wrong" 'printf X | dd of="$file" bs=1 seek=5000 conv=notrunc 2>/dev/null'
damaged "a file cut short" "it was cut short" 'truncate -s -100 "$file"'
damaged "an empty file" "no checkpoint of sphode" ': >"$file"'
damaged "another format" "of format 9; this sphode .* reads format 1" 'sed -i "2s/format 1/format 9/" "$file"'
damaged "another file" "no checkpoint of sphode" 'cp dam.yml "$file"'
damaged "a damaged header" "header is damaged" 'printf X | dd of="$file" bs=1 seek=300 conv=notrunc 2>/dev/null'
rm -rf hurt
cp -r base hurt
for file in hurt/out/checkpoint_*; do truncate -s 1000 "$file"; done
run 1 hurt "$sphode" restart out -q && grep -q "none of its checkpoints can be used" err && [[ $(grep -c "cut short" err) == 2 ]]
ok $? "without a good one it fails, and says why of each"
rm -rf hurt
cp -r base hurt
head -c 100 base/out/series.csv >hurt/out/series.csv
run 0 hurt "$sphode" restart out -q && grep -q "warning: out/series.csv is cut short: it begins anew" err
ok $? "rows that are missing are told"
run 1 . "$sphode" restart none/out && grep -q "none/out holds no checkpoint (checkpoint_\*.hdf); sphode run none/out/case.yml -o" err && mkdir bare &&
  run 1 . "$sphode" restart bare && grep -q "bare holds no checkpoint (checkpoint_\*.hdf), nor a case.yml: right is the directory of a run" err
ok $? "a directory without checkpoints"
run 1 . "$sphode" restart nowhere && grep -q "nowhere: No such file" err
ok $? "no directory"

# ---- no space

# Files of at most this size, larger than snapshots, smaller than checkpoints: writes fail as on a full disk.
size=$(stat -c %s "$(newest base)")
if (ulimit -f $((size / 1024 - 1)) && exec "$sphode" check dam.yml) >out 2>err; then
  mkdir full
  (cd full && ulimit -f $((size / 1024 - 1)) && exec "$sphode" run "${case[@]}" >../out 2>../err)
  [[ $? == 1 ]] && grep -q "cannot write out/checkpoint_.*hdf ([0-9]* bytes): File too large" err && ! ls full/out/*.tmp 2>/dev/null
  ok $? "a checkpoint that does not fit ends the run, told"
  cp -r base full2
  before=$(cksum full2/out/checkpoint_*)
  (cd full2 && ulimit -f $((size / 1024 - 1)) && exec "$sphode" restart out -q >../out 2>../err)
  [[ $? == 1 ]] && grep -q "cannot write" err && grep -q "restart out goes on from" err && [[ $before == "$(cksum full2/out/checkpoint_*)" ]]
  ok $? "and the state before is kept"
else # ThreadSanitizer's own file is larger
  cp -r base full2
  for name in "a checkpoint that does not fit ends the run, told" "and the state before is kept"; do
    ok 0 "$name # SKIP the program itself does not run with files of $((size / 1024 - 1)) kB"
  done
fi
run 0 full2 "$sphode" restart out -q
ok $? "with space again it goes on"
if [[ $(id -u) != 0 ]]; then
  cp -r base shut
  chmod a-w shut/out
  run 1 shut "$sphode" restart out -q && grep -q "cannot write out" err
  ok $? "an unwritable directory"
  chmod u+w shut/out
else
  ok 0 "an unwritable directory # SKIP root may write anywhere"
fi
# Vortices that decay: they are fastest at the start.
mach() { grep '"mach_largest"\|"density_deviation_largest"' slow/out/summary.json; }
run 0 slow "$sphode" run "$SRCDIR/cases/taylor-green-2d.yml" -o out -q --set dx=L/20 --set nu=0.2 --set run.end=0.1 --set output.snapshots=0.1 --set "compare=[]" && mach >before &&
  run 0 slow "$sphode" restart out -q --until 0.3 && [[ -s before ]] && mach | diff before -
ok $? "the largest Mach number is that of the whole run"
echo 1..$count
