#!/usr/bin/env bash
# sphode spectrum: what it finds, writes and refuses.
source "$SRCDIR/tests/tap.sh"
wave=$SRCDIR/cases/acoustic-wave-1d.yml

refused() { # STATUS, name, what the message says, arguments...
  local status=$1 name=$2 says=$3
  shift 3
  run "$status" "$sphode" spectrum "$@" && grep -q "^sphode: .*$says" err && [[ ! -s out ]]
  ok $? "$name"
}

# ---- sound on a lattice: all eigenvalues are imaginary, and Bogacki & Shampine's limit is sqrt(3)

run 0 "$sphode" spectrum "$wave" -o wave --frozen --set spacing=1/32 &&
  [[ -s wave/spectrum.csv && -s wave/spectrum.txt && -s wave/regions.csv ]] &&
  cmp -s <(grep -v "^results\|^picture\|^$" out) <(grep -v "^$" wave/spectrum.txt) &&
  [[ $(wc -l <wave/spectrum.csv) == 65 ]]
ok $? "a spectrum leaves tables, and tells what stands in one of them"

awk '/^oscillation/ { most = $4 } /^erk:bogacki-shampine/ { z = most * $2 }
  END { print "# largest |Im| times the longest step: " z; exit !(z > 1.73 && z < 1.74) }' wave/spectrum.txt
ok $? "the longest step of a scheme is that of its region"

awk -F, 'NR > 1 { r = $2 < 0 ? -$2 : $2; if (r > most) most = r; if ($1 > grow || -$1 > grow) grow = $1 < 0 ? -$1 : $1 }
  END { print "# " most, grow; exit !(grow < 0.01 * most) }' wave/spectrum.csv
ok $? "waves neither grow nor decay"

run 0 "$sphode" spectrum "$wave" -o later -q --frozen --set spacing=1/32 --until 0.1s && [[ ! -s out ]] &&
  grep -q "t = 0.1 s, 64 eigenvalues, positions held" later/spectrum.txt
ok $? "the state at another time"

run 0 "$sphode" spectrum "$wave" -o few --frozen --set spacing=1/32 --integrators erk:zonneveld-5-3-4 &&
  [[ $(cut -d, -f1 few/regions.csv | sort -u | grep -c erk:) == 1 ]]
ok $? "regions of chosen integrators"

# ---- refusals

refused 1 "too many eigenvalues" "at most 4000.*--set spacing" "$SRCDIR/cases/taylor-green-2d.yml"
refused 2 "an integrator that is not explicit" "no explicit integrator" "$wave" -o bad --set spacing=1/32 \
  --integrators imex:ark324l2sa-4-2-3
refused 2 "too many of them" "9 of them; at most 8" "$wave" -o bad --set spacing=1/32 \
  --integrators "$(printf 'leapfrog,%.0s' {1..8})dkd"
[[ ! -e bad && ! -e taylor-green-2d-spectrum ]]
ok $? "what is refused leaves no folder"
sed 's/^  pressure:.*/&\n  shifting: {speed: 1 m\/s, advection: false}/' "$wave" >shifted.yml
line=$(grep -n "^  shifting" shifted.yml | cut -d: -f1)
refused 1 "a term without derivatives, at its place" "shifted.yml:$line:3: no derivatives of a right-hand side with shifting" shifted.yml -o bad --set spacing=1/32
refused 1 "what ended stays" "force" "$wave" -o wave --set spacing=1/32
run 0 "$sphode" spectrum --help && grep -q -- --frozen out
ok $? "help"
echo "1..$count"
