#!/usr/bin/env bash
# A full disk, in memory, of a namespace of its own: what does not fit is told with its file and the reason, the exit status is 1,
# and what was there is whole. (Checkpoints: test_restart.sh.)
sphode=${SPHODE:-$BUILDDIR/sphode}
names=("results of a run" "a case file" "files of a case" "a series and snapshots" "a table that does not fit keeps its results" "a sweep"
  "can be made again" "an export" "a picture" "a picture that was there" "the neighbourhood of a failure" "a run with a page"
  "with space again it is all made")
unshare=(unshare -m)
[[ $(id -u) == 0 ]] || unshare=(unshare -rm)
if [[ -z $SPHODE_FULL_DISK ]]; then
  SPHODE_FULL_DISK=$(mktemp -d) || exit 99
  trap 'rm -rf "$SPHODE_FULL_DISK"' EXIT
  export SPHODE_FULL_DISK
  if ! "${unshare[@]}" mount -t tmpfs -o size=64k none "$SPHODE_FULL_DISK" 2>/dev/null; then
    echo "1..${#names[@]}"
    for ((k = 1; k <= ${#names[@]}; k++)); do echo "ok $k - ${names[k - 1]} # SKIP no file systems may be mounted here"; done
    exit
  fi
  "${unshare[@]}" bash "$0"
  exit
fi
cd "$SPHODE_FULL_DISK" || exit 99
mkdir disk && mount -t tmpfs -o size=4m none disk || exit 99
export OMP_WAIT_POLICY=passive

count=0
ok() { # 0 or not
  [[ $1 == 0 ]] && echo "ok $((count + 1)) - ${names[count]}"
  [[ $1 == 0 ]] || { echo "not ok $((count + 1)) - ${names[count]}"; sed 's/^/# /' out err; ls -lR disk | sed 's/^/# /'; }
  count=$((count + 1))
}
leave() { # kB of the disk; all: nothing is in the way
  rm -f disk/fill
  [[ $1 == all ]] || dd if=/dev/zero of=disk/fill bs=1k count=$(($(df -k --output=avail disk | tail -n 1) - $1)) 2>/dev/null
}
run() { # STATUS COMMAND...
  local wanted=$1 status
  shift
  "$@" >out 2>err
  status=$?
  [[ $status == "$wanted" ]] || { echo "# exit status $status, wanted $wanted: $*" && return 1; }
}
full="No space left on device"
whole() { ! find disk -name '*.tmp' -o -name '*.old' | grep -q .; } # nothing half made is left
cat >tank.yml <<'END'
dimension: 2
parameters: {H: 0.6 m}
spacing: H/20
groups:
  water:
    kind: fluid
    density: 1000 kg/m^3
    eos: {tait: {sound_speed: 30 m/s}}
    shapes: [box: {lower: [0, 0], upper: [H, H]}]
  tank:
    kind: wall
    density: 1000 kg/m^3
    shapes: [layers: {lower: [0, 0], upper: [2*H, 2*H]}]
terms: {continuity: , pressure: , gravity: {acceleration: [0, -9.81 m/s^2]}}
run: {end: 0.05 s}
output: {snapshots: 0.01 s}
compare: [{name: kinetic energy, quantity: kinetic, norm: mean, reference: {value: 1}}]
END
{ echo t,x && seq 1 4000 | sed 's/$/,1/'; } >long.csv

run 0 "$sphode" run tank.yml -o disk/good -q && cp -r disk/good good
ok $?
leave 0
run 1 "$sphode" run tank.yml -o disk/a -q && grep -q "cannot write disk/a/case.yml: $full" err && [[ -z $(ls disk/a) ]]
ok $?
leave 20
run 1 "$sphode" run tank.yml -o disk/b -q --set 'tables={a: {file: long.csv}}' &&
  grep -q "cannot write disk/b/files/long.csv ([0-9]* bytes): $full" err && [[ -z $(ls disk/b/files) ]] && whole
ok $?
rm -r disk/a disk/b
leave 200
run 1 "$sphode" run tank.yml -o disk/c -q && grep -q "disk/c: cannot write .*disk/c/.*: $full" err && whole && [[ -e disk/c/snapshot_0000.hdf ]]
bad=$?
for k in disk/c/snapshot_*.hdf disk/c/walls_*.hdf; do [[ $(head -c 4 "$k" | tail -c 3) == HDF ]] || bad=1; done
ok $bad
rm -r disk/c
# What is at an end stays as it was: the run that goes on finds no space for its first file.
leave 0
before=$(cat disk/good/* | cksum)
run 1 "$sphode" restart disk/good --until 0.06s -q && grep -q "cannot write.*disk/good/.*: $full" err && [[ $before == $(cat disk/good/* | cksum) ]] && whole
ok $?
leave 0
run 1 "$sphode" sweep tank.yml --vary H=0.5m,0.6m -o disk/sweep && grep -q "cannot write disk/sweep/sweep.csv: $full" err &&
  [[ $(grep -c "H=0.[56]m: failed, and its .log cannot be written" err) == 2 ]] && whole
ok $?
leave all
run 0 "$sphode" sweep tank.yml --vary H=0.3m,0.4m -o disk/sweep -q --set output.snapshots=0.05s && [[ $(wc -l <disk/sweep/sweep.csv) == 3 ]]
ok $?
rm -r disk/sweep
leave 60
run 1 "$sphode" export disk/good --vtu && grep -q "cannot write disk/good/vtu/.*vtu ([0-9]* bytes): $full" err && whole
ok $?
rm -r disk/good/vtu
if command -v gnuplot >/dev/null; then
  rm -f disk/good/frames.*
  leave 100
  run 1 "$sphode" plot disk/good && grep -q "no picture: .*disk/good/frames.png" err && [[ ! -e disk/good/frames.png ]] && whole
  ok $?
  leave all
  "$sphode" plot disk/good --frames 1 >out 2>err
  picture=$(cksum <disk/good/frames.png)
  leave 100
  run 1 "$sphode" plot disk/good --frames 6 && grep -q "no picture: .*disk/good/frames.png" err && [[ $(cksum <disk/good/frames.png) == "$picture" ]] && whole
  ok $?
else
  for k in 1 2; do echo "ok $((++count)) - ${names[count - 1]} # SKIP no gnuplot"; done
fi
rm -rf disk/good
blow=(--set integrator.method=leapfrog --set integrator.cfl=8 --set "run.end=1s" --set "output.snapshots=1s" --set "output.series=1s")
leave all
run 1 "$sphode" run tank.yml -o disk/d -q "${blow[@]}" && size=$(stat -c %s disk/d/snapshot_0000.hdf)
rm -r disk/d
leave $((size / 1024 + 24)) # for the start, not for the last state
run 1 "$sphode" run tank.yml -o disk/d -q "${blow[@]}" && grep -q "the run has blown up.*not all outputs have that state: .*$full" err &&
  [[ -e disk/d/snapshot_0000.hdf && ! -e disk/d/snapshot_0001.hdf ]] && whole
ok $?
rm -rf disk/d
leave 150
if "$sphode" run tank.yml -o disk/e -q --live 2>&1 | grep -q "built without libmicrohttpd"; then
  echo "ok $((++count)) - ${names[count - 1]} # SKIP no libmicrohttpd"
else
  rm -rf disk/e
  run 1 "$sphode" run tank.yml -o disk/e -q --live && grep -q "^live  *http://127.0.0.1" err && grep -q "cannot write .*disk/e/.*: $full" err && whole
  ok $?
fi
rm -rf disk/e
leave all
run 0 "$sphode" run tank.yml -o disk/good -q && cmp good/series.csv disk/good/series.csv && [[ $(ls good) == $(ls disk/good) ]]
ok $?
echo "1..${#names[@]}"
