#!/usr/bin/env bash
# Markers of a ChArUco board are often 0.8 of a square wide or more. OpenCV's detectMarkers with its usual
# settings takes the white square around such a marker for the same outline and keeps the square, which is
# no marker. In sharp pictures of OpenCV's own drawing it finds only markers at the rim and a few corners:
# boards look out of reach of the camera, and calibrations rest on what is left.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need python3-opencv 4.6.0

/usr/bin/python3 - <<'END'
import sys

import cv2

COLUMNS, ROWS, PIXELS = 8, 11, 100
dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)


def found(share, distance=None):
    board = cv2.aruco.CharucoBoard_create(COLUMNS, ROWS, 0.03, 0.03 * share, dictionary)
    picture = board.draw(((COLUMNS + 2) * PIXELS, (ROWS + 2) * PIXELS), marginSize=PIXELS)
    parameters = cv2.aruco.DetectorParameters_create()
    if distance:
        parameters.minMarkerDistanceRate = distance
    markers, ids, _ = cv2.aruco.detectMarkers(picture, dictionary, parameters=parameters)
    corners = cv2.aruco.interpolateCornersCharuco(markers, ids, picture, board)[0]
    return len(ids), corners


markers, corners = COLUMNS * ROWS // 2, (COLUMNS - 1) * (ROWS - 1)
narrow, wide, apart = found(0.75), found(0.8), found(0.8, 0.03)
print(f"expected: {markers} markers and {corners} corners, whatever the markers' width")
print(f"seen:     {narrow} with markers of 0.75 of a square, {wide} with 0.8;")
print(f"          {apart} with 0.8 and minMarkerDistanceRate 0.03 in place of 0.05")
whole = (markers, corners)
sys.exit(0 if narrow == whole and apart == whole and wide[1] < corners / 2 else 1)
END
