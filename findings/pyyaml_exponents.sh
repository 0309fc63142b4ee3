#!/usr/bin/env bash
# Small distortion coefficients are printed as 5e-05 by Python, C and C++, and calibrations in YAML
# are often written by such prints and read by PyYAML, as ROS and Kalibr do. PyYAML reads a number
# with an exponent but without a point as text, and 12:30 as 750, while JSON and YAML 1.2 have
# numbers and text there. A lens then fails far from its file, or only for the one camera whose
# coefficient happens to be small.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need python3-yaml 6.0

/usr/bin/python3 - <<'END'
import json
import sys

import yaml

written = [5e-05, 1e22, -0.25]
text = "[" + ", ".join(repr(number) for number in written) + "]"  # [5e-05, 1e+22, -0.25]
seen = yaml.safe_load(text)
time = yaml.safe_load("12:30")
print(f"expected: {text} is {json.loads(text)}, as in JSON, and 12:30 is text")
print(f"seen:     {text} is {seen}, and 12:30 is {time!r}")
sys.exit(0 if seen == ["5e-05", "1e+22", -0.25] and time == 750 else 1)
END
