#!/usr/bin/env bash
# headers.sh HOST COMPILER FLAG...: compiles every header under HOST by itself, so that each includes
# what it needs. Names the headers that do not compile and exits 1.
#
# Eigen takes longer than the headers themselves, so those that include Eigen/Core, be it through
# others, find it precompiled. They include it first or after headers that are checked, too, so it gives
# them nothing that they do not ask for.
set -euo pipefail
host=$(cd "$1" && pwd)
shift
export compile="$*"
export eigen
eigen=$(mktemp -d)
trap 'rm -rf "$eigen"' EXIT
cd "$host"

mapfile -t headers < <(find moclean -name '*.hpp' | sort)
((${#headers[@]} > 0)) || { echo "headers: none under $host"; exit 1; }

# The headers that include Eigen/Core; then again and again those that include one of them.
mapfile -t found < <(grep -l '^#include <Eigen/Core>' "${headers[@]}" || true)
declare -A has_eigen=()
while ((${#found[@]} > 0)); do
  patterns=()
  for header in "${found[@]}"; do has_eigen[$header]=1 patterns+=(-e "#include \"$header\""); done
  mapfile -t found < <(grep -lF "${patterns[@]}" "${headers[@]}" |
    while read -r header; do [[ -v has_eigen[$header] ]] || echo "$header"; done)
done
if ((${#has_eigen[@]} > 0)); then
  echo '#include <Eigen/Core>' >"$eigen/core.hpp"
  $compile -x c++-header "$eigen/core.hpp" -o "$eigen/core.hpp.gch"
fi

check() {  # HEADER, or HEADER+ where Eigen/Core comes first
  local include=(-include "${1%+}")
  [[ $1 == *+ ]] && include=(-include "$eigen/core.hpp" "${include[@]}")
  $compile -fsyntax-only -Winvalid-pch -Werror=invalid-pch "${include[@]}" -x c++ /dev/null ||
    { echo "${1%+}: does not compile alone"; return 1; }
}
export -f check

for header in "${headers[@]}"; do printf '%s\0' "$header${has_eigen[$header]:++}"; done |
  xargs -0 -P "$(nproc)" -I {} bash -c 'check {}' ||
  { echo 'headers: some do not compile alone'; exit 1; }
echo "headers: ${#headers[@]} compile alone, ${#has_eigen[@]} of them with Eigen precompiled"
