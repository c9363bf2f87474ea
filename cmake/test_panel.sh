#!/usr/bin/env bash
# The page's own tests (Vitest). 77 tells ctest that they were skipped.
set -euo pipefail
cd "$(dirname "$0")/../hmi/web"
[ -f node_modules/.madori ] && [ -f dist/.inputs ] || { echo "skipped: the page was not built (no npm, or no registry)"; exit 77; }
npm test
