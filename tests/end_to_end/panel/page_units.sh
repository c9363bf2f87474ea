#!/bin/sh
# page_units.sh NPM PAGE: the page's own tests.
cd "$2" || exit 1
test -d node_modules || { echo "skipped: needs npm ci in hmi/web"; exit 77; }
exec "$1" test
