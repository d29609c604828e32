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

# A frame that is damaged: told, and nothing is left.
head -c 3000 run/snapshot_0003.hdf >cut && cp cut run/snapshot_0003.hdf
refused 1 "no movie: run/snapshot_0003.hdf" run -o b.mp4 && [[ ! -e b.mp4 ]]
ok $? "a damaged frame"
cp cut run/snapshot_0000.hdf
refused 1 "no movie: run/snapshot_0000.hdf" run -o b.mp4 && [[ ! -e b.mp4 ]]
ok $? "a damaged frame, the first of all"

echo 1..$count
