#!/usr/bin/env bash
# An edit list of an MP4 file says which parts of a video players show, and an empty edit between two
# parts means a pause (ISO/IEC 14496-12, 8.6.6). FFmpeg honours an empty edit in the first place only;
# in a later one it shows the beginning of the video again, at the times of the pause. Programs that read
# recordings with it get frames of another moment, without an error and with times that look right.
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
need python3 3.11

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# Frame n of ten is grey 25.6 n, of 255.
ffmpeg -v error -f lavfi -i "color=black:size=64x64:rate=10:duration=1" -vf "geq=lum=16+22*N:cb=128:cr=128" \
  -pix_fmt yuv420p -g 1 -c:v libx264 -qp 0 "$folder/whole.mp4"
/usr/bin/python3 - "$folder" <<'END'
import struct, sys
data = open(sys.argv[1] + "/whole.mp4", "rb").read()
units = struct.unpack(">I", data[data.find(b"mdhd") + 16:][:4])[0]  # of the video's times, per second
at = data.find(b"elst") - 4
size = struct.unpack(">I", data[at:at + 4])[0]
edits = [(500, 0), (200, -1), (300, units * 7 // 10)]  # 0.5 s from 0 s on, 0.2 s of pause, 0.3 s from 0.7 s on
content = b"".join(struct.pack(">IiHH", length, start, 1, 0) for length, start in edits)
head = struct.pack(">I4sII", 16 + len(content), b"elst", 0, 3)
edited = bytearray(data[:at] + head + content + data[at + size:])
for box in (b"edts", b"trak", b"moov"):  # hold it, behind the pictures
    place = edited.find(box) - 4
    old = struct.unpack(">I", edited[place:place + 4])[0]
    edited[place:place + 4] = struct.pack(">I", old + 16 + len(content) - size)
open(sys.argv[1] + "/edited.mp4", "wb").write(edited)
END
seen=$(ffmpeg -v error -i "$folder/edited.mp4" -fps_mode passthrough -f rawvideo -pix_fmt gray - |
  /usr/bin/python3 -c 'import sys; d = sys.stdin.buffer.read()[::64 * 64]; print(*[round(x / 25.6) for x in d])')
echo "expected: frames 0 1 2 3 4, a pause, 7 8 9"
echo "seen:     frames $seen"
[ "$seen" = "0 1 2 3 4 0 1 7 8 9" ]
