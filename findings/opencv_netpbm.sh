#!/usr/bin/env bash
# A PGM file says in its header which value is white, and a PAM file says whether its three values
# are red, green and blue. OpenCV divides by white where the values are text but not where they are
# bytes, and it exchanges red and blue of PAM. The same picture is then four times darker or has
# other colours, depending on the form that a program happens to write.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:12
need libopencv-dev 4.6.0

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/main.cpp" <<'END'
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>

int main() {
  const auto pixel = [](const std::string& file) {
    const std::vector<char> bytes(file.begin(), file.end());
    return cv::imdecode(bytes, cv::IMREAD_COLOR).at<cv::Vec3b>(0, 0);
  };
  const cv::Vec3b text = pixel("P2\n1 1\n63\n63\n"), bytes = pixel("P5\n1 1\n63\n?"),
                  ppm = pixel("P6\n1 1\n255\n\xFF@ "),
                  pam = pixel("P7\nWIDTH 1\nHEIGHT 1\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n\xFF@ ");
  std::printf("expected: white (255) from both PGM files, and the same blue from PPM and PAM\n");
  std::printf("seen:     text %d, bytes %d; blue %d from PPM, %d from PAM\n", text[0], bytes[0],
              ppm[0], pam[0]);
  return text[0] == 255 && bytes[0] == 63 && ppm[0] == 32 && pam[0] == 255 ? 0 : 1;
}
END
# shellcheck disable=SC2046  # several flags
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" \
  $(pkg-config --cflags opencv4) -lopencv_imgcodecs -lopencv_core
"$folder/main"
