#!/usr/bin/env bash
# headers.sh HOST COMPILER FLAG...: compiles every header under HOST by itself, so that each includes
# what it needs. Names the headers that do not compile and exits 1.
#
# What headers include takes longer than the headers themselves, so many are compiled at a time, and that still shows
# each of them alone. A chain is a header, one that includes it, be it through others, one that includes that,
# and so on: the first has nothing before it, and the next only what it asks for. Likewise those that
# include Eigen/Core find it precompiled. They include it first or after headers that are checked, too.
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

# Each line a chain: + before the headers if they include Eigen/Core. A header goes to the longest chain whose
# last it includes; those that include least come first.
awk '
  FNR == 1 { header[++headers] = FILENAME }
  /^#include ["<]/ { gsub(/"/, "", $2); includes[FILENAME] = includes[FILENAME] " " $2 }
  function visit(file, top,   parts, n, i) {  # notes in reached what top includes
    n = split(includes[file], parts, " ")
    for (i = 1; i <= n; ++i)
      if (!((top, parts[i]) in reached)) {
        reached[top, parts[i]]
        if (parts[i] ~ /[.]hpp$/) ++count[top]
        visit(parts[i], top)
      }
  }
  function has_eigen(file) { return (file, "<Eigen/Core>") in reached }
  END {
    for (h = 1; h <= headers; ++h) {
      visit(header[h], header[h])
      if (count[header[h]] > most) most = count[header[h]]
    }
    for (c = 0; c <= most; ++c)
      for (h = 1; h <= headers; ++h) {
        file = header[h]
        if (count[file] + 0 != c) continue
        best = 0
        for (i = 1; i <= chains; ++i)
          if ((file, last[i]) in reached && has_eigen(file) == has_eigen(last[i]) && length_of[i] > length_of[best]) best = i
        if (best == 0) { best = ++chains; chain[best] = has_eigen(file) ? "+" : "-" }
        last[best] = file
        ++length_of[best]
        chain[best] = chain[best] " " file
      }
    for (i = 1; i <= chains; ++i) print chain[i]
  }' "${headers[@]}" >"$eigen/chains"

if grep -q '^+' "$eigen/chains"; then
  echo '#include <Eigen/Core>' >"$eigen/core.hpp"
  $compile -x c++-header "$eigen/core.hpp" -o "$eigen/core.hpp.gch"
fi

compiles() {  # +|- HEADER...
  local include=() header
  [[ $1 == + ]] && include=(-include "$eigen/core.hpp")
  for header in "${@:2}"; do include+=(-include "$header"); done
  $compile -fsyntax-only -Winvalid-pch -Werror=invalid-pch "${include[@]}" -x c++ /dev/null
}
check() {  # CHAIN: if it does not compile, each header by itself
  local header status=0 headers
  read -ra headers <<<"$1"
  compiles "${headers[@]}" 2>/dev/null && return 0
  for header in "${headers[@]:1}"; do
    compiles "${headers[0]}" "$header" || { echo "$header: does not compile alone"; status=1; }
  done
  ((status == 1)) || echo "${headers[*]:1}: do not compile one after the other"
  return 1
}
export -f compiles check

xargs -d '\n' -P "$(nproc)" -I {} bash -c 'check "$0"' {} <"$eigen/chains" ||
  { echo 'headers: some do not compile alone'; exit 1; }
echo "headers: ${#headers[@]} compile alone, in $(wc -l <"$eigen/chains") chains," \
  "$(grep -c '^+' "$eigen/chains" || true) of them with Eigen precompiled"
