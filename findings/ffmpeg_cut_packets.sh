#!/usr/bin/env bash
# Recordings are cut without encoding them again, and frames of two cameras are then counted to pair
# them. A cut of HEVC with open groups of pictures keeps packets at its beginning that depend on what
# was cut off, and no player ever shows them. Whoever counts packets is some frames late from the
# first one on, and a stereo pair that is late by one frame is centimetres wrong.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need ffmpeg 7:5.1

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
ffmpeg -v error -f lavfi -i testsrc=size=320x240:rate=30:duration=1 -pix_fmt yuv420p \
  -c:v libx265 -x265-params open-gop=1:keyint=8:min-keyint=8:log-level=error "$folder/whole.mkv"
ffmpeg -v error -ss 0.5 -i "$folder/whole.mkv" -c copy "$folder/cut.mkv"
count() { # packets | frames
  ffprobe -v error -select_streams v -"count_$1" -show_entries "stream=nb_read_$1" -of csv=p=0 \
    "$folder/cut.mkv" 2>/dev/null
}
packets=$(count packets) frames=$(count frames)
echo "expected: the cut has as many packets as frames"
echo "seen:     $packets packets, $frames frames"
[ "$packets" -gt "$frames" ]
