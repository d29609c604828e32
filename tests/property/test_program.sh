#!/usr/bin/env bash
# The program: what it prints, how it exits, what it leaves behind.
source "$SRCDIR/tests/tap.sh"
dam=$SRCDIR/cases/dam-break-2d.yml
# Seconds at most: 50 columns of 10 particles, a tenth of the time.
small=(--set "parameters.dx=H/10" --set "run.end=T" --set "output.snapshots=T/2" --set "output.series=T/20" --lenient)
# Hours, to be stopped.
long=(--set "parameters.dx=H/40" --set "run.end=1000*T" --set "output.snapshots=1000*T" --set "output.series=T/100")

usage() { # name, what the message says, arguments...
  local name=$1 says=$2
  shift 2
  run 2 "$sphode" "$@" && [[ ! -s out ]] && grep -q "^sphode: .*$says" err && grep -q "^Try 'sphode" err
  ok $? "$name"
}
fails() { # name, what the message says, arguments...
  local name=$1 says=$2
  shift 2
  run 1 "$sphode" "$@" && grep -q "^sphode: .*$says" err
  ok $? "$name"
}

# ---- help and bad usage

run 0 "$sphode" --version && grep -qx "sphode [0-9.]*" out
ok $? "--version"
run 0 "$sphode" --help && [[ ! -s err ]] && for c in run restart check info plot work-precision; do grep -q "^  $c " out || break; done
ok $? "--help names the commands"
good=0
for c in run restart check info plot work-precision; do run 0 "$sphode" $c --help && grep -q "^Usage: sphode $c " out || good=1; done
ok $good "each command has a help"
usage "no command" "no command"
usage "an unknown command" "'rnu' is no command; did you mean 'run'?" rnu
usage "another one" "'chekc' is no command; did you mean 'check'?" chekc
usage "one that is like none" "'cheese' is no command$" cheese
usage "an unknown option" "unrecognized option '--frobnicate'" run --frobnicate "$dam"
usage "an option of another command" "check takes no --force" check --force "$dam"
usage "an option without its value" "requires an argument" run "$dam" --output
usage "no argument" "run wants one CASE.yml, found 0" run
usage "two arguments" "found 2" run "$dam" "$dam"
usage "threads that are no number" "--threads 1e3: wanted a whole number" run --threads 1e3 "$dam"
usage "no threads" "--threads 0" run --threads 0 "$dam"
usage "more threads than the library takes" "from 1 to 1024" run --threads 1025 "$dam"
run 2 "$sphode" info pets && grep -q "known are kernels, eos, materials, terms" err
ok $? "an unknown list names the known ones"
run 2 "$sphode" info kernels --csv --q 0,x && grep -q "found 'x'" err && [[ ! -s out ]]
ok $? "a bad q is refused before anything is printed"

# ---- info

# All kernels that the table (computed elsewhere to 22 digits) holds, at its q.
table=$SRCDIR/tests/data/kernel_table.csv
q=$(awk -F, '!/^#/ && !/^kernel/ && !seen[$3]++ { printf "%s%s", n++ ? "," : "", $3 }' "$table")
run 0 "$sphode" info kernels --csv --q "$q" && head -1 out | grep -qx "kernel,dim,q,W,dWdr,laplacian" &&
  awk -F, '
    function far(a, b) { d = a - b; s = b < 0 ? -b : b; return (d < 0 ? -d : d) > 1e-12 * (1 + s) }
    /^#/ || /^kernel/ { next }
    { gsub("_", "-", $1) }
    FNR == NR { w[$1 "," $2 "," $3 + 0] = $4; f[$1 "," $2 "," $3 + 0] = $5; next }
    { key = $1 "," $2 "," $3 + 0 }
    key in w { found++; if (far($4, w[key]) || far($5, f[key])) { print "# " $0 " against " w[key] " " f[key]; bad++ } }
    END { print "# " found " values"; exit !(found == 138 && !bad) }' "$table" out
ok $? "kernels as in the table of the literature"
run 0 "$sphode" info kernels && ! grep -q '.\{101\}' out && grep -q "^wendland-c2  *2 h  *C2  *1.5  *24  *92 " out
ok $? "the table of kernels fits 100 columns and has the neighbors of wendland-c2"
run 0 "$sphode" info kernels --spacing 0.01 --dim 3 && ! grep -q '.\{101\}' out &&
  grep -q "^wendland-c2  *1.3-2  *1.5  *0.015  *0.03  *92 +3.1e-03 .* no$" out &&
  grep -q "^cubic-spline  *1.1-1.3  *1.2  *0.012  *0.024  *56 +8.1e-04 .* -6e-04$" out &&
  grep -q "^cubic-spline  *1.41\* " out && ! grep -q "2D" out
ok $? "kernels at a spacing: those of the literature, and at equal resolution the cubic spline is out of its range"
run 0 "$sphode" info kernels --spacing 0.01 --json && { ! command -v python3 >/dev/null || python3 -c '
import json, sys
rows = json.load(sys.stdin)
assert len(rows) == 16
for r in rows:
    e, o = r["equal-resolution"], r["recommended"]
    assert abs(r["sigma-k"] * e["h"] / (rows[0 if r["dim"] == 2 else 8]["sigma-k"] * 0.015) - 1) < 1e-6
    assert abs(o["support"] / o["h"] - round(o["support"] / o["h"])) < 1e-6 and o["fits"]' <out; }
ok $? "... as JSON: sigma_k h is the same for all"
run 2 "$sphode" info kernels --spacing 1cn && grep -q -e "--spacing 1cn: wanted a length > 0, as 0.01" err && [[ ! -s out ]]
ok $? "a spacing that is none"
"$sphode" info kernels --spacing 0.01 >metres
run 0 "$sphode" info kernels --spacing 1cm && cmp out metres && run 0 "$sphode" info kernels --spacing "10 mm" && cmp out metres
ok $? "one in centimetres"
usage "a dimension too many" "from 1 to 3" info kernels --spacing 1 --dim 4
run 2 "$sphode" info kernels --dim 2 && grep -q -e "wants --spacing" err && [[ ! -s out ]]
ok $? "a dimension without spacing"
run 2 "$sphode" info terms --spacing 1 && grep -q -e "belong to info kernels" err && [[ ! -s out ]]
ok $? "a spacing of terms"
good=0
for list in kernels eos materials terms integrators boundaries searches; do
  run 0 "$sphode" info $list && [[ -s out ]] || good=1
  run 0 "$sphode" info $list --json && { ! command -v python3 >/dev/null || python3 -m json.tool <out >/dev/null; } || good=1
done
ok $good "each list, for people and as JSON"
# Nothing is lost where lines are broken: the words are those of the JSON.
good=0
for list in eos materials terms integrators boundaries searches; do
  run 0 "$sphode" info $list && ! grep -q '.\{101\}' out || good=1
  tr -s ' \n' ' ' <out >words
  "$sphode" info $list --json | sed -n 's/.*"\(formula\|about\)": "\(.*\)"}.*/\2/p' >texts
  while IFS= read -r text; do grep -qF " $text " words || { good=1; echo "# $text"; }; done <texts
  [[ $list == integrators || -s texts ]] || good=1
done
ok $good "lists fit 100 columns and have each word of the JSON"
"$sphode" info kernels --json | grep -q '"name": "wendland-c2", "smoothness": "C2", "support/h": 2, "h/dx": 1\.' &&
  "$sphode" info integrators --json | grep -q '"name": "leapfrog", "order": 2, "stages": 1, "error-control": false, "stability": 0\.'
ok $? "numbers and flags in JSON are none of its strings"
run 0 "$sphode" info case && grep -q "spacing" out
ok $? "the manual of case files"
"$sphode" info case >/dev/full 2>err
[[ $? == 1 ]] && grep -q "^sphode: cannot write" err
ok $? "a full standard output is an error"

# ---- check

good=0
mkdir empty
for c in "$SRCDIR"/cases/*.yml; do
  coarse=()
  [[ $c == *-3d-* ]] && coarse=(--set parameters.n=8)
  [[ $c == */piston-hill-3d.yml ]] && coarse=(--set dx=4cm)
  (cd empty && "$sphode" check "${coarse[@]}" "$c") >out 2>err || { good=1; sed 's/^/# /' err; }
done
ok $good "the cases that come along are right"
[[ -z $(ls empty) ]]
ok $? "check writes nothing"
fails "a file that is not there" "nothing.yml: .*No such file" check nothing.yml
sed 's/^spacing:/spacng:/' "$dam" >broken.yml
fails "a broken case tells its line" "broken.yml:[0-9]*:1: unknown key 'spacng'.*spacing" check broken.yml
fails "a wrong unit in --set" "spacing" check --set "spacing=1 s" "$dam"
fails "an unknown key in --set" "spacng" check --set "spacng=1 m" "$dam"

# ---- run

run 0 "$sphode" run "$dam" "${small[@]}" -o d1 && grep -q "Martin & Moyce" out && grep -q "^results *d1$" out &&
  [[ -s d1/case.yml && -s d1/summary.json && -s d1/series.csv && -s d1/snapshot_0000.hdf && -s d1/snapshot_0002.hdf ]]
ok $? "a small run leaves case, summary, series and snapshots"
run 0 "$sphode" check d1/case.yml && ls d1/files | grep -qx '+..+data+koshizuka_oka_1996.csv'
ok $? "the case that was kept can be read again, with the tables that were"
if command -v gnuplot >/dev/null; then
  [[ -s d1/frames.png && -s d1/compare_0.png ]] && run 0 "$sphode" plot d1 --field pressure --frames 2 && grep -q "d1/frames.png" out
  ok $? "its pictures"
  run 1 "$sphode" plot d1 --field temperature && grep -q 'no field "temperature"; it has: .*density, .*velocity' err &&
    run 1 "$sphode" plot d1 --field preszure && grep -q "no field \"preszure\"; did you mean 'pressure'" err && run 0 "$sphode" plot d1 --field id
  ok $? "a field that a run has not is told with those that it has"
  rm d1/compare_0.png
  run 0 "$sphode" plot d1 && grep -q "d1/compare_0.png" out && [[ -s d1/compare_0.png ]]
  ok $? "comparisons again"
  run 0 "$sphode" plot d1 --series kinetic,potential && grep -q "d1/series.png" out && [[ -s d1/series.png ]] &&
    grep -q "potential" d1/series.gp && run 0 "$sphode" plot d1 --series kinetic --over potential &&
    run 1 "$sphode" plot d1 --series kinetik && grep -q 'no column "kinetik" among time' err &&
    run 2 "$sphode" plot d1 --over time && grep -q "want --series" err
  ok $? "curves of a table"
else
  for what in "its pictures" "a field that a run has not" "comparisons again" "curves of a table"; do ok 0 "$what # SKIP no gnuplot"; done
fi
run 0 "$sphode" export d1/snapshot_0002.hdf --csv -o one && [[ -s one/snapshot_0002.csv && -s one/walls_0002.csv && ! -e one/snapshot_0000.csv ]] &&
  grep -q "^snapshot_0002.csv," one/times.csv
ok $? "an export of one snapshot has its number"
# Scripts of pictures are there without gnuplot, too.
run 0 "$sphode" run "$SRCDIR/cases/lid-driven-cavity-2d.yml" --lenient -o cavity --set parameters.n=8 --set parameters.L=0.5m --set parameters.U=2m/s \
  --set "output.probes={p: {interval: 0.01 s, plane: {corner: [0, 0], along: [L, 0], across: [0, L/2], n_along: 5, n_across: 3}},
    l: {interval: 0.01 s, line: {from: [0, 0], to: [L, 0], n: 5}}}" \
  --set run.end=0.02s --set output.snapshots=0.01s --set "compare.0.window=[0, 1]" --set "compare.1.window=[0, 1]" &&
  grep -qF "set xlabel 'y / (0.5 m)'" cavity/compare_0.gp && grep -qF "set ylabel 'velocity_x / (2 m/s)'" cavity/compare_0.gp &&
  grep -qF "set ylabel 'velocity_y / (2 m/s)'" cavity/compare_1.gp
ok $? "comparisons along a section have units at their axes"
"$sphode" plot cavity --table probe_p.csv --field density --frames 2 >out 2>err || grep -q "no gnuplot found" err
grep -qF "set cblabel 'density [kg/m^3]'" cavity/probe_p.gp && grep -q "cell_x = 0.065/length" cavity/probe_p.gp && [[ $(grep -c "^[0-9]" cavity/probe_p.dat) == 30 ]] &&
  run 1 "$sphode" plot cavity --table probe_l.csv --field pressure && grep -q "places lie on a line; curves draw it" err &&
  run 1 "$sphode" plot cavity --table probe_p.csv --field preszure && grep -q 'no column "preszure" among' err
ok $? "a plane of a probe is drawn as maps, a line is not"
# Chosen times: the nearest ones; the numbers are those of the tables and of the snapshots.
draws() { "$sphode" plot "$@" >out 2>err || grep -q "no gnuplot found" err; } # the script is there in any case
same() { # DATA TABLE AWK: rows of the script's data are those that the program prints of the table
  awk '/^#/ { next } NF == 2 { print $1 + 0, $2 + 0 }' "$1" >drawn
  awk -F, "$3" "$2" >wanted
  [[ -s wanted && $(wc -l <drawn) == "$(wc -l <wanted)" ]] &&
    paste -d ' ' drawn wanted | awk '{ for (k = 1; k <= 2; k++) { d = $k - $(k + 2); if (d * d > 1e-16 * $k * $k) bad = 1 } } END { exit bad }'
}
draws cavity --table probe_l.csv --series density --over x --at 14ms &&
  same cavity/probe_l.dat cavity/probe_l.csv '$1 > 0.005 && $1 < 0.015 { print $2 + 0, $NF + 0 }' && [[ $(wc -l <wanted) == 5 ]] &&
  grep -q "density \[kg/m^3\], t = 0.01 s" cavity/probe_l.gp
ok $? "a profile of a table at the time nearest to another"
run 0 "$sphode" export cavity --format csv && draws cavity --series velocity_y,velocity_x --over y --at 14ms,99s &&
  { for field in velocity_y velocity_x; do for k in 1 2; do awk -F, -v f="$field" -v k=$k 'NR == 1 { for (c = 1; c <= NF; c++) { gsub(/"| \[.*/, "", $c); at[$c] = c } next }
    { print $(at["y"]) + 0 "," $(at[f]) + 0 }' cavity/csv/snapshot_000$k.csv; done; done; } >all.csv && same cavity/profiles.dat all.csv '{ print $1, $2 }' && [[ $(wc -l <wanted) == 256 ]] &&
  grep -q "velocity_x \[m/s\], t = 0.01.* s" cavity/profiles.gp && grep -q "velocity_y \[m/s\], t = 0.02.* s" cavity/profiles.gp
ok $? "profiles of the particles at two times"
draws cavity --table probe_p.csv --field density --at 0.004,0.011 && [[ $(sed -n 's/^# t = \(.*\) s, .*/\1/p' cavity/probe_p.dat | tr '\n' ' ') == "0 0.01 " ]]
ok $? "maps at chosen times"
draws cavity --at 20ms,0.004 && [[ $(sed -n 's/^# t = \([0-9.]*\) s, fluids/\1/p' cavity/frames.dat | awk '{ printf "%.3f ", $1 }') == "0.020 0.000 " ]]
ok $? "snapshots at chosen times"
run 2 "$sphode" plot cavity --at 0.1,x && grep -q -e "--at 0.1,x: wanted 1 to 16 times" err && run 2 "$sphode" plot cavity --at 0.1, && run 2 "$sphode" plot cavity --at 0.1s1 &&
  run 2 "$sphode" plot cavity --at 0.1 --table probe_l.csv --series density && grep -q "wants --over" err
ok $? "times that are none"
# 3D: which slice is seen.
if command -v gnuplot >/dev/null; then
  run 0 "$sphode" check "$SRCDIR/cases/piston-hill-3d.yml" --set dx=4cm --picture hill.png && grep -q "over a hill, slice y = 0.12 m, 0.06 m thick'" hill.gp &&
    awk 'NF == 2 { n++ } END { exit !(n > 100) }' hill.dat &&
    run 0 "$sphode" run "$SRCDIR/cases/piston-hill-3d.yml" -q -o hill --lenient --set dx=4cm --set run.end=1ms && run 0 "$sphode" plot hill --frames 1 &&
    grep -q "^set label 1 't = 0 s, slice y = 0.12 m, 0.06 m thick'" hill/frames.gp
  ok $? "slices of 3D tell their place and thickness"
else
  ok 0 "slices of 3D # SKIP no gnuplot"
fi
# A panel for each unit, in the order of the columns; one axis of time.
draws d1 --series kinetic,dt,potential,front && awk '
  /^set ylabel/ { panel[++n] = $3 " " $4 } /^set xlabel / && /time/ { x[n]++ }
  /data index/ { held[n] = held[n] " " $0 } /^set xrange/ { ranges++ }
  END { exit !(n == 3 && panel[1] ~ /\[J\/m\]/ && held[1] ~ /kinetic.*potential/ && panel[2] ~ /dt \[s\]/ && held[2] ~ /index 1 / && held[2] !~ /kinetic|front/ &&
    panel[3] ~ /front \[m\]/ && held[3] ~ /index 3 / && ranges == 1) }' d1/series.gp && [[ $(grep -c "^set format x ''" d1/series.gp) == 2 && $(grep -c "^set format x '%g'" d1/series.gp) == 1 ]]
ok $? "columns of several units: a panel for each"
draws d1 --series kinetic,potential && ! grep -q multiplot d1/series.gp && grep -qF "set ylabel '[J/m]'" d1/series.gp
ok $? "columns of one unit: one panel"
before=$(cksum d1/* | cksum)
fails "a run that ended is not written over" "d1 holds a run that ended or was stopped" run "$dam" "${small[@]}" -o d1
[[ $before == "$(cksum d1/* | cksum)" ]]
ok $? "and nothing of it changed"
touch d1/notes.txt d1/snapshot_0099.hdf
run 0 "$sphode" run "$dam" "${small[@]}" -o d1 --force -q && [[ ! -s out && ! -s err && -e d1/notes.txt && ! -e d1/snapshot_0099.hdf ]]
ok $? "--force writes over it, leaves what is not a run's, and --quiet says nothing"
rm d1/summary.json
fails "nor is one that can go on" "d1 holds a run that was interrupted; sphode restart d1" run "$dam" "${small[@]}" -o d1
rm d1/checkpoint_*
run 0 "$sphode" run "$dam" "${small[@]}" -o d1 -q
ok $? "a run that was killed before its first checkpoint is written over"
run 0 "$sphode" run "$dam" "${small[@]}" -o d2 --threads 2 -q && cmp d1/series.csv d2/series.csv
ok $? "two threads give the same bits"
run 3 "$sphode" run "$dam" "${small[@]}" --strict -o d3 -q --set compare.0.bar=1e-9 &&
  grep -q "d3: [1-9] of [0-9]* comparisons miss.* its bar" err && [[ -s d3/summary.json ]]
ok $? "a missed bar is exit status 3, where it is not asked for --lenient"
fails "an output directory that cannot be made" "cannot make the directory" run "$dam" "${small[@]}" -o broken.yml/out

# ---- stopped

stopped() { # signal, status
  "$sphode" run "$dam" "${long[@]}" -o "$1" -q 2>err &
  local job=$! tries=0
  until [[ $(wc -l 2>/dev/null <"$1/series.csv") -gt 3 || $((tries++)) -gt 600 ]]; do sleep 0.1; done 2>/dev/null
  if [[ $1 == INT ]]; then
    fails "a directory in use is refused" "another run is writing to INT" run "$dam" "${small[@]}" -o INT --force
    : >err
  fi
  kill -s "$1" $job
  wait $job
  local status=$?
  [[ $status == "$2" ]] && grep -q '"error": "stopped on request' "$1/summary.json" && ! ls "$1"/*.tmp 2>/dev/null
  local good=$?
  [[ $good == 0 ]] || echo "# exit status $status, wanted $2"
  ok $good "SIG$1 ends a run with its files whole"
}
stopped INT 130
stopped TERM 143

# ---- a page while it goes

"$sphode" run "$dam" "${long[@]}" -o live -q --live 2>err &
job=$! tries=0
until [[ -s live/series.csv || $((tries++)) -gt 600 ]] || ! kill -0 $job 2>/dev/null; do sleep 0.1; done
if grep -q "built without libmicrohttpd" err; then
  for what in "units of the page" "a port that is taken" "... before a restart"; do ok 0 "$what # SKIP no libmicrohttpd"; done
else
  read -r port token < <(sed -n 's|^live  *http://127.0.0.1:\([0-9]*\)/\([0-9a-f]*\)/$|\1 \2|p' err)
  page() { # what the page has of the run
    exec 3<>"/dev/tcp/127.0.0.1/$port" && printf 'GET /%s/frame HTTP/1.0\r\n\r\n' "$token" >&3 && tr -d '\0' <&3
    exec 3>&-
  }
  tries=0
  until page 2>/dev/null | grep -aq '"fields"' || ((tries++ > 100)); do sleep 0.1; done
  page | grep -aq '\["mass","kg/m"\]'
  ok $? "units of the page are those of 2D"
  before=$(cksum d1/* TERM/* | cksum)
  fails "a port that is taken" "cannot listen on 127.0.0.1, port $port: Address already in use" run "$dam" "${small[@]}" -o taken "--live=$port"
  run 1 "$sphode" run "$dam" "${small[@]}" -o d1 --force "--live=$port" && run 1 "$sphode" restart TERM "--live=$port" &&
    [[ ! -e taken && $before == "$(cksum d1/* TERM/* | cksum)" ]]
  ok $? "... is told before anything is written"
fi
kill $job 2>/dev/null
wait $job
echo 1..$count
