#!/usr/bin/env bash
# run_examples.sh BUILD_DIR SOURCE_DIR: installs BUILD_DIR into a temporary folder, builds examples/
# against it and runs them on a rendered recording.
set -euo pipefail
build_dir=$1
source_dir=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
unset HYPOTRACK_PLUGIN_PATH HYPOTRACK_DATA_PATH
export CXXFLAGS="-Wall -Wextra -Werror"  # as authors may compile

fail() { echo "$1"; exit 1; }

cmake --install "$build_dir" --prefix "$scratch/prefix" >"$scratch/install.log"
hypotrack=$scratch/prefix/bin/hypotrack
cd "$scratch"
cp -r "$source_dir/examples/track_frames" "$source_dir/examples/track_mesh_in_memory" \
  "$source_dir/examples/plugin_source" "$source_dir/examples/plugin_prior" .
"$hypotrack" synth "$source_dir/configs/scenes/demo.yaml" --frames 4 --out recording
python3 "$source_dir/tests/system/out_of_tree/make_euroc.py" recording euroc

# A program that tracks, with a scene that names no source.
cat >scene.yaml <<'END'
models:
  - {name: hand, type: hand}
tracker: "@trackers/recommended"
init:
  pose:
    hand: {position_mm: [60, 80, 500], rotation_deg: [180, 0, 0], angles_deg: {thumb_abduction: 25}}
END
cmake -S track_frames -B track_frames/build -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build track_frames/build
track_frames/build/track_frames scene.yaml recording/calibration.yaml recording/left_000000.png \
  recording/right_000000.png recording/left_000001.png recording/right_000001.png >tracked.txt
cat tracked.txt
[ "$(grep -c ': tracked$' tracked.txt)" = 2 ] || fail "not both frames were tracked"
# The program prints what the run's own table of landmarks has, within its rounding of 0.1 mm.
"$hypotrack" run scene.yaml --frames 2 --out result --set 'source={type: image_sequence,
  left: recording/left_%06d.png, right: recording/right_%06d.png,
  calibration: {file: recording/calibration.yaml}}'
python3 - <<'END'
import csv
row = next(csv.DictReader(open("result/joints.csv")))
printed = [line.split() for line in open("tracked.txt") if line.startswith("  ")]
for name, *xyz, _ in printed[: len(printed) // 2]:
    for axis, value in zip("xyz", xyz):
        assert abs(float(value) - 1000 * float(row[f"{name}_{axis}"])) < 0.06, (name, axis, value)
END
track_frames/build/track_frames scene.yaml recording/calibration.yaml none.png none.png \
  >/dev/null 2>message.txt && fail "a missing picture was tracked"
grep -q 'view 0 has no image' message.txt || fail "unexpected message: $(cat message.txt)"

# A program that makes its scene, its mesh and its pictures.
cmake -S track_mesh_in_memory -B track_mesh_in_memory/build -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build track_mesh_in_memory/build
track_mesh_in_memory/build/track_mesh_in_memory | tee in_memory.txt
[ "$(grep -c '^frame .: tracked, [0-3]\..* mm off$' in_memory.txt)" = 10 ] ||
  fail "not all of ten frames were tracked within 4 mm"

# A source of one's own.
mkdir plugin_source/build
echo "folder: $scratch/euroc" >plugin_source/build/contract.yaml
cmake -S plugin_source -B plugin_source/build -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build plugin_source/build
ctest --test-dir plugin_source/build --output-on-failure
cat >euroc.yaml <<'END'
models:
  - {name: hand, type: hand}
source: {type: euroc, folder: euroc}
tracker: "@trackers/recommended"
init:
  pose:
    hand: {position_mm: [60, 80, 500], rotation_deg: [180, 0, 0], angles_deg: {thumb_abduction: 25}}
END
"$hypotrack" --plugin-path plugin_source/build run euroc.yaml --out euroc_result
[ "$(grep -c ',tracked,' euroc_result/track.csv)" = 3 ] || fail "expected three tracked frames"
[ "$(grep -c ',missing,' euroc_result/track.csv)" = 1 ] || fail "expected one missing frame"

# A prior with a Jacobian of its own, beside a term with slopes.
mkdir plugin_prior/build
echo "file: $scratch/recording/truth_states.csv" >plugin_prior/build/contract.yaml
cmake -S plugin_prior -B plugin_prior/build -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build plugin_prior/build
ctest --test-dir plugin_prior/build --output-on-failure
cat >prior.yaml <<'END'
models:
  - {name: hand, type: hand}
source: {type: image_sequence, left: recording/left_%06d.png, right: recording/right_%06d.png,
         calibration: {file: recording/calibration.yaml}}
objective:
  - {type: stereo_color, beta: 5}
  - {type: regressor, file: recording/truth_states.csv, weight: 100}
optimizer: {type: levenberg_marquardt, jacobian: analytic}
search: {rotation_as: tangent}
init:
  pose:
    hand: {position_mm: [60, 80, 500], rotation_deg: [180, 0, 0], angles_deg: {thumb_abduction: 25}}
END
"$hypotrack" --plugin-path plugin_prior/build run prior.yaml --out prior_result
[ "$(grep -c ',tracked,' prior_result/track.csv)" = 4 ] || fail "expected four tracked frames"
python3 - <<'END'
import csv
rows, truths = (list(csv.DictReader(open(file)))
                for file in ["prior_result/track.csv", "recording/truth_states.csv"])
for row, truth in zip(rows, truths):
    for axis in "xyz":
        name = f"hand.position_{axis}"
        assert abs(float(row[name]) - float(truth[name])) < 0.005, (row["frame"], name, row[name], truth[name])
END

# An installation that lost OpenCV's readers of images says so.
rm "$(find "$scratch/prefix" -name libhypotrack_media.so)"
"$hypotrack" run recording/scene.yaml --out without_images 2>message.txt && fail "pictures were read"
grep -q 'images and videos need .*libhypotrack_media.so, which cannot be loaded: ' message.txt ||
  fail "unexpected message: $(cat message.txt)"
