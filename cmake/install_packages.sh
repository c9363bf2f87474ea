#!/usr/bin/env bash
# Installs the packages of cmake/packages.txt that this Debian machine lacks; says nothing when all are there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
wanted=$(grep -vE '^[[:space:]]*(#|$)' "$here/packages.txt")
# shellcheck disable=SC2086
have=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | sed -n 's/^installed //p' || true)
missing=$(comm -23 <(sort -u <<<"$wanted") <(sort -u <<<"$have") | tr '\n' ' ')
[ -n "${missing// /}" ] || exit 0
as_root=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "madori: not installed: $missing- run this once as root" >&2; exit 1; }
  as_root=sudo
fi
echo "Installing Debian packages: $missing"
$as_root apt-get update -qq
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
