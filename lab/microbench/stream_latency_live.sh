#!/usr/bin/env bash
# stream_latency_live.sh BUILD_DIR [FRAMES [TRACKER]]: bench_stream_latency with a live source: two MJPEG streams of
# this machine play the rendered hand of demo.yaml to and fro, 30 pairs of 1280x720 per second. TRACKER: real_time.
set -euo pipefail
build=$(realpath "$1")
here=$(realpath "$(dirname "$0")/../..")
folder=$(mktemp -d)
servers=()
trap 'kill "${servers[@]}" 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"

"$build/bin/hypotrack" record "$here/configs/scenes/demo.yaml" --frames 20 --format jpeg --out recording
for view in left right; do
  for i in $(seq 0 19); do
    picture=recording/$(printf '%s_%06d.jpg' "$view" "$i")
    ln "$picture" "$(printf '%s_%02d.jpg' "$view" "$i")"
    ln "$picture" "$(printf '%s_%02d.jpg' "$view" $((39 - i)))"
  done
  /usr/bin/python3 "$here/tests/support/mjpeg_server.py" "$folder/${view}_*.jpg" --port-file "port_$view" &
  servers+=($!)
done
until [ -e port_left ] && [ -e port_right ]; do sleep 0.1; done
cat >scene.yaml <<END
models:
  - {name: hand, type: hand}
source:
  type: camera
  left: "http://127.0.0.1:$(cat port_left)/stream"
  right: "http://127.0.0.1:$(cat port_right)/stream"
  calibration: {file: recording/calibration.yaml}
tracker: "@trackers/${3:-real_time}"
init:
  from: rest
  pose: {hand: {position_mm: [50, 85, 490], rotation_deg: [175, 0, 6], angles_deg: {thumb_abduction: 35}}}
END
"$build/bin/bench_stream_latency" scene.yaml "${2:-300}"
