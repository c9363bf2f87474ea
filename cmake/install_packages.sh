#!/usr/bin/env bash
# Installs the packages of cmake/packages.txt that this Debian machine lacks; says nothing when all are there.
# Usage: install_packages.sh [--tests]: also those for the tests alone. What only the touch panel needs is
# tried and, where it cannot be had, said: Madori drives without it.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

section() {  # NAME: the packages below "# [NAME]"
  awk -v wanted="# [$1]" '/^# \[/ {inside = index($0, wanted) == 1; next} inside && !/^[[:space:]]*(#|$)/' "$here/packages.txt"
}
missing_of() {
  local have
  # shellcheck disable=SC2086
  have=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $1 2>/dev/null | sed -n 's/^installed //p' || true)
  comm -23 <(sort -u <<<"$1") <(sort -u <<<"$have") | tr '\n' ' '
}
install() {
  local as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "madori: not installed: $1- run this once as root" >&2; return 1; }
    as_root=sudo
  fi
  echo "Installing Debian packages: $1"
  $as_root apt-get update -qq && DEBIAN_FRONTEND=noninteractive \
    $as_root apt-get install -y -qq --no-install-recommends $1 >/dev/null
}

missing=$(missing_of "$(section build)")
[ -z "${missing// /}" ] || install "$missing"

# Node.js may come from elsewhere than Debian; any npm with Node.js 18 or newer will do.
if ! command -v npm >/dev/null || ! command -v node >/dev/null; then
  install "$(section panel | tr '\n' ' ')" || echo "madori: no Node.js, so the touch panel's page is not built" >&2
fi
missing=$(missing_of "$(section camera)")
[ -z "${missing// /}" ] || install "$missing" || echo "madori: not installed: $missing- no camera picture on the panel" >&2
if [ "${1:-}" = --tests ]; then
  missing=$(missing_of "$(section tests)")
  [ -z "${missing// /}" ] || install "$missing" || echo "madori: not installed: $missing- tests that need it are skipped" >&2
fi
