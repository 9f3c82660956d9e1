#!/usr/bin/env bash
# headers_selftest.sh COMPILER FLAG...: checks that headers.sh refuses a header that lacks an include
# and accepts one that has it.
set -euo pipefail
checker=$(dirname "$0")/headers.sh
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/moclean"

echo '#include <string>
inline std::string complete() { return "a"; }' >"$planted/moclean/complete.hpp"
"$checker" "$planted" "$@" >/dev/null || { echo 'refused a header that is complete'; exit 1; }

echo 'inline std::vector<int> lacking() { return {1}; }' >"$planted/moclean/lacking.hpp"
if output=$("$checker" "$planted" "$@" 2>&1); then
  echo 'accepted a header that lacks <vector>'
  exit 1
fi
[[ $output == *'moclean/lacking.hpp: does not compile alone'* ]] || { echo "not named: $output"; exit 1; }
echo 'headers: an incomplete header is named'
