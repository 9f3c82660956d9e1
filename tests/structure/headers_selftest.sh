#!/usr/bin/env bash
# headers_selftest.sh COMPILER FLAG...: checks that headers.sh accepts headers that include what they need
# and names each that does not, also where Eigen comes precompiled.
set -euo pipefail
checker=$(dirname "$0")/headers.sh
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/moclean"

plant() { { echo "#pragma once"; cat; } >"$planted/moclean/$1.hpp"; }
check() { "$checker" "$planted" "$@" "-I$planted" 2>&1; }

plant complete <<<'#include <string>
inline std::string complete() { return "a"; }'
plant direct <<<'#include <Eigen/Core>
inline Eigen::Index direct() { return 1; }'
plant indirect <<<'#include "moclean/direct.hpp"
inline Eigen::Index indirect() { return direct(); }'
output=$(check "$@") || { echo "refused headers that are complete: $output"; exit 1; }
[[ $output == *'3 compile alone, in 2 chains, 1 of them with Eigen'* ]] || { echo "chains not seen: $output"; exit 1; }

plant no_vector <<<'inline std::vector<int> lacking() { return {1}; }'
plant no_eigen <<<'inline Eigen::Index lacking() { return 1; }'
plant no_optional <<<'#include "moclean/indirect.hpp"
inline std::optional<int> lacking() { return {}; }'
# One that lacks what the header that includes it has.
plant no_array <<<'inline std::array<int, 1> lacking() { return {}; }'
plant has_array <<<'#include <array>
#include "moclean/no_array.hpp"
inline int of_array() { return lacking()[0]; }'
if output=$(check "$@"); then echo 'accepted headers that lack an include'; exit 1; fi
for lacking in no_vector no_eigen no_optional no_array; do
  [[ $output == *"moclean/$lacking.hpp: does not compile alone"* ]] || { echo "$lacking not named: $output"; exit 1; }
done
[[ $output == *': some do not'* && $output != *complete.hpp:* ]] || { echo "$output"; exit 1; }
echo 'headers: an incomplete header is named'
