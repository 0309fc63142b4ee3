#!/usr/bin/env bash
# package.sh [OUT]: installs what is missing, builds, and makes Debian packages in OUT (default: build/packages).
# Where a CUDA toolkit is, hypotrack-cuda is one of them; CUDAARCHS=89 builds it for one generation of GPUs alone.
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "${BASH_SOURCE[0]}")/../build/packages}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/setup.sh
install_missing_packages packages-package.txt
build package
cuda=()
if [ -n "${CUDACXX:-}" ] || command -v nvcc >/dev/null || [ -x /usr/local/cuda/bin/nvcc ]; then
  configure package_cuda
  cmake --build --preset package_cuda --target hypotrack_library  # all else comes from the other build
  cuda=(build/package_cuda)
else
  echo "hypotrack-cuda is not made: there is no CUDA toolkit" >&2
fi
debian/make.sh build/package "$out" "${cuda[@]}"
lintian --fail-on error $(find "$out" -name "*.deb")
echo "To install the packages: sudo apt-get install $out/*.deb"
