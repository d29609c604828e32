#!/usr/bin/env bash
# sphode movie, as ffprobe and ffmpeg see what it made: all frames, the rate, the size, one scale of colours in all frames.
source "$SRCDIR/tests/tap.sh"

refused() { # STATUS MESSAGE ARGUMENT...
  "$sphode" movie "${@:3}" >out 2>&1
  [[ $? == "$1" ]] && grep -qF -e "$2" out || { sed 's/^/# /' out && false; }
}

"$sphode" run "$SRCDIR/cases/dam-break-2d.yml" -q -o run --set parameters.dx=H/10 --set run.end=T --lenient \
  --set output.snapshots=T/4 --set output.series=T/2 >out 2>&1 || sed 's/^/# /' out
[[ -e run/snapshot_0004.hdf && ! -e run/snapshot_0005.hdf ]]
ok $? "a run of five frames"

refused 2 "--range 3: wanted FROM:TO" run --range 3 && refused 2 "--range 3:2: wanted" run --range 3:2 &&
  refused 2 "--size 3: wanted WIDTHxHEIGHT" run --size 3 && refused 2 "--rate 0: wanted a whole number" run --rate 0
ok $? "options that are none"
refused 1 'movie "run.avi": a name like x.mp4, x.png or x.apng' run -o run.avi &&
  refused 1 "nowhere: No such file" nowhere && refused 1 "401 x 300 pixels; an mp4 wants even numbers" run --size 401x300 &&
  refused 1 "32 x 300 pixels; 64 to" run --size 32x300
ok $? "movies that are none"
mkdir bin
ln -s /usr/bin/* bin/ && rm -f bin/ffmpeg
PATH=$stage/bin refused 1 "no ffmpeg found, which makes movies of frames: install ffmpeg" run && [[ ! -e run/movie.mp4.frames ]]
ok $? "no ffmpeg: told before anything is drawn"

for program in gnuplot ffmpeg ffprobe; do
  command -v "$program" >/dev/null || { ok 0 "movies # SKIP no $program" && echo "1..$count" && exit; }
done
probe() { # FILE KEYS: values with commas between
  ffprobe -v error -count_frames -select_streams v:0 -show_entries "stream=$2" -of csv=p=0 "$1"
}
is() { # FOUND RIGHT
  [[ $1 == "$2" ]] || { echo "# found $1, right is $2" && false; }
}

"$sphode" movie run --size 640x480 --rate 10 -o 'a movie.mp4' >out && is "$(cat out)" "movie        a movie.mp4 (5 frames)" &&
  is "$(probe 'a movie.mp4' codec_type,width,height,pix_fmt,r_frame_rate,duration,nb_read_frames)" "video,640,480,yuv420p,10/1,0.500000,5"
ok $? "mp4: frames, rate, duration, size"
"$sphode" movie run -q && [[ $(probe run/movie.mp4 r_frame_rate,nb_read_frames) == 25/1,5 ]]
ok $? "mp4 by default, in the directory of the run"
"$sphode" movie run --field pressure --size 401x301 --rate 4 -q -o p.png && is "$(probe p.png codec_name,width,height,r_frame_rate,nb_read_frames)" "apng,401,301,4/1,5"
ok $? "animated PNG: frames, rate, size"
[[ $(find . -name '*.frames' -o -name '*.tmp' -o -name '*.gp') == "" ]]
ok $? "nothing is left behind"

# The scale of colours is right of the picture; the particles move.
part() { # FILE FRAME CROP
  ffmpeg -v error -nostdin -i "$1" -vf "select=eq(n\,$2),crop=$3" -fps_mode passthrough -frames:v 1 -f rawvideo -pix_fmt rgb24 - | cksum
}
"$sphode" movie run --field velocity --size 800x800 -q -o v.png
scale=110:iw:iw-110:0 field=iw-130:ih-60:0:60
is "$(part v.png 4 "$scale")" "$(part v.png 0 "$scale")" && is "$(part v.png 2 "$scale")" "$(part v.png 0 "$scale")" &&
  [[ $(part v.png 4 $field) != "$(part v.png 0 $field)" ]]
ok $? "one scale of colours for all frames"
"$sphode" movie run --field velocity --size 800x800 --range 0:9 -q -o w.png
[[ $(part w.png 4 $scale) != "$(part v.png 4 $scale)" ]] && is "$(part w.png 4 $scale)" "$(part w.png 0 $scale)"
ok $? "a range of one's own"

# An ffmpeg that fails: its words are told, and nothing is left.
printf '#!/bin/sh\n[ "$1" = -version ] || { echo no such encoder; exit 1; }\n' >bin/ffmpeg
chmod +x bin/ffmpeg
PATH=$stage/bin refused 1 "ffmpeg could not make b.mp4: no such encoder" run -o b.mp4 && [[ ! -e b.mp4 && ! -e b.mp4.frames ]]
ok $? "a failing ffmpeg"

# Frames that are damaged or missing: told, left out of movies, pictures, exports; exit status 1 tells that they were.
left() { # NUMBER ALL WHAT...: what was told
  local number=$1 all=$2 what=0
  shift 2
  for name in "$@"; do grep -q "^sphode: left out: .*$name" err || what=1; done
  [[ $what == 0 && $(grep -c "left out: " err) == $# ]] && grep -q "^sphode: $number of $all snapshots wa*e*r*s*e* left out$" err || { sed 's/^/# /' err && false; }
}
cp -r run whole
head -c 3000 run/snapshot_0003.hdf >cut && cp cut run/snapshot_0003.hdf && rm run/snapshot_0001.hdf
run 1 "$sphode" movie run -q -o b.mp4 && left 2 5 "run/snapshot_0001.hdf: it is missing" "run/snapshot_0003.hdf: " && is "$(probe b.mp4 nb_read_frames)" 3 &&
  [[ ! -e b.mp4.frames ]]
ok $? "a movie without damaged and missing frames"
run 1 "$sphode" export run --format csv,vtu && left 2 5 snapshot_0001 snapshot_0003 && [[ $(ls run/csv/snapshot_* run/vtu/snapshot_*.vtu | wc -l) == 6 && $(grep -c "^snapshot" run/csv/times.csv) == 3 && $(grep -c "<DataSet" run/vtu/snapshot.pvd) == 3 ]] &&
  "$sphode" export whole --format csv -q && cmp run/csv/snapshot_0004.csv whole/csv/snapshot_0004.csv
ok $? "... an export"
run 1 "$sphode" plot run --frames 4 && left 1 4 snapshot_0003 && [[ $(grep -c "fluids$" run/frames.dat) == 3 ]]
ok $? "... a sheet"
run 1 "$sphode" plot run --at 0,1e9 && left 1 4 snapshot_0003 && [[ $(grep -c "fluids$" run/frames.dat) == 2 ]] &&
  run 1 "$sphode" plot run --at 0,1e9 --series velocity --over x && left 1 4 snapshot_0003
ok $? "... pictures at chosen times"
cp cut run/snapshot_0000.hdf
run 1 "$sphode" movie run -q -o b.mp4 && left 3 5 snapshot_0000 snapshot_0001 snapshot_0003 && is "$(probe b.mp4 nb_read_frames)" 2
ok $? "the first of all is damaged"
for k in 2 4; do cp cut run/snapshot_000$k.hdf; done
rm b.mp4
run 1 "$sphode" movie run -o b.mp4 && grep -q "no movie: run: none of its snapshots can be read" err && [[ ! -e b.mp4 && ! -e b.mp4.frames ]] &&
  run 1 "$sphode" export run --csv -o none && grep -q "none of its snapshots can be read" err && run 1 "$sphode" plot run && grep -q "none of its snapshots" err
ok $? "none can be read"
run 1 "$sphode" export run/snapshot_0003.hdf --csv -o none && grep -q "run/snapshot_0003.hdf" err && ! grep -q "left out" err && [[ ! -e none ]]
ok $? "one that is asked for alone is an error"

# Stopped, while frames are drawn and while ffmpeg makes the movie: nothing is left, the movie before stays.
slow() { printf '#!/bin/sh\n[ "$1" = -version ] && exit 0\n%s\n' "$1" >bin/ffmpeg; }
interrupted() { # SIGNAL STATUS UNTIL: a condition
  cp b.mp4 before.mp4
  PATH=$stage/bin "$sphode" movie whole -o b.mp4 >out 2>err &
  local job=$! tries=0
  until eval "$3" || ((tries++ > 600)); do sleep 0.02; done
  kill -s "$1" $job
  wait $job
  is $? "$2" && grep -q "stopped; no movie was written" err && [[ ! -e b.mp4.frames && ! -e b.mp4.tmp ]] && cmp b.mp4 before.mp4
}
echo old >b.mp4
slow 'for last; do :; done; echo half >"${last#file:}"; echo $$ >"'"$stage"'/encoding"; exec sleep 100'
interrupted TERM 143 '[[ -e b.mp4.frames/frame_00001.png ]]'
ok $? "SIGTERM while frames are drawn"
interrupted INT 130 '[[ -e b.mp4.frames/frame_00000.png ]]'
ok $? "SIGINT"
rm -f encoding
interrupted TERM 143 '[[ -s encoding ]]' && ! kill -0 "$(<encoding)" 2>/dev/null
ok $? "SIGTERM while ffmpeg makes the movie, which ends, too"

echo 1..$count
