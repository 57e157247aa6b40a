#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests; arguments are passed on to ctest.
# The last line is `N passed, N failed, N skipped`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake/prepare.sh
cmake --build --preset release

results=$(mktemp --suffix=.xml)
trap 'rm -f "$results"' EXIT
status=0
ctest --preset release -j 2 --no-tests=error --output-junit "$results" "$@" || status=$?

# The number in the attribute $1 of the results' first element.
count() { sed -nE "0,/[[:space:]]$1=/s/.*[[:space:]]$1=\"([0-9]+)\".*/\1/p" "$results"; }
total=$(count tests) failed=$(count failures) skipped=$(($(count skipped) + $(count disabled)))
echo "$((total - failed - skipped)) passed, $failed failed, $skipped skipped"
exit "$status"
