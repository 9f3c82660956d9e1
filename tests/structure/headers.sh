#!/usr/bin/env bash
# headers.sh HOST COMPILER FLAG...: compiles every header under HOST by itself, so that each includes
# what it needs. Names the headers that do not compile and exits 1.
set -euo pipefail
host=$1
shift
export compile="$*"

check() { $compile -fsyntax-only -include "$1" -x c++ /dev/null || { echo "$1: does not compile alone"; return 1; }; }
export -f check

cd "$host"
mapfile -t headers < <(find moclean -name '*.hpp' | sort)
((${#headers[@]} > 0)) || { echo "headers: none under $host"; exit 1; }
printf '%s\0' "${headers[@]}" | xargs -0 -P "$(nproc)" -I {} bash -c 'check {}' ||
  { echo 'headers: some do not compile alone'; exit 1; }
echo "headers: ${#headers[@]} compile alone"
