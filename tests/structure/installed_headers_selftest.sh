#!/usr/bin/env bash
# installed_headers_selftest.sh: checks that installed_headers.sh names a header that is missing, and accepts
# a folder without any gap.
set -euo pipefail
checker=$(dirname "$0")/installed_headers.sh
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/moclean"

if "$checker" "$planted" >/dev/null 2>&1; then echo 'accepted a folder without headers'; exit 1; fi
echo '#include <vector>' >"$planted/moclean/a.hpp"
echo '#include "moclean/a.hpp"' >"$planted/moclean/b.hpp"
"$checker" "$planted" >/dev/null || { echo 'refused headers that are all there'; exit 1; }
rm "$planted/moclean/a.hpp"
if output=$("$checker" "$planted"); then echo 'accepted a missing header'; exit 1; fi
[[ $output == *'moclean/b.hpp:1: includes moclean/a.hpp'* ]] || { echo "not named: $output"; exit 1; }
echo 'installed headers: a missing one is named'
