#!/usr/bin/env bash
# Installs what is missing, configures once, builds. Usage: cmake/build.sh [cmake --build arguments]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
"$root/cmake/install_packages.sh" ${MADORI_FOR_TESTS:+--tests}
cd "$root"
if [ ! -f build/release/build.ninja ]; then
  cmake --preset release >build-configure.log 2>&1 || { cat build-configure.log >&2; exit 1; }
  rm -f build-configure.log
fi
cmake --build build/release "$@"
