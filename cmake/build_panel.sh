#!/usr/bin/env bash
# Builds the touch panel's page into hmi/web/dist, when anything of it has changed since. Without Node.js or
# without the npm registry (first time only) it says so and succeeds: everything else works without the page.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
web=$root/hmi/web
say() { echo "panel: $*"; }

if ! command -v npm >/dev/null || ! node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null; then
  say "not built: npm and Node.js 18 or newer are missing (Debian: apt-get install nodejs npm)"
  exit 0
fi
exec 9>"$web/.build.lock"
flock 9  # two build folders share the page
cd "$web"
hash_of() { cat "$@" | sha256sum | cut -d' ' -f1; }
lock=$(hash_of package.json package-lock.json)
if [ "$(cat node_modules/.madori 2>/dev/null)" != "$lock" ]; then
  say "fetching its packages (npm ci)"
  if ! npm ci --no-audit --no-fund --fetch-retries=1 --fetch-timeout=20000 >.build.log 2>&1; then
    tail -n 5 .build.log >&2
    say "not built: its packages cannot be fetched; everything else works without it. Once online: cmake --build build/release --target panel"
    exit 0
  fi
  echo "$lock" >node_modules/.madori
fi
inputs=$( (find src public scripts -type f ! -name api_types.ts -print0 | sort -z | xargs -0 sha256sum
  sha256sum index.html package-lock.json tsconfig.json vite.config.ts ../schema/api.schema.json) | sha256sum | cut -d' ' -f1)
[ "$(cat dist/.inputs 2>/dev/null)" != "$inputs" ] || exit 0
npm run build >.build.log 2>&1 || { cat .build.log >&2; say "its build failed, see above"; exit 1; }
echo "$inputs" >dist/.inputs
say "$(grep '^page weight' .build.log)"
