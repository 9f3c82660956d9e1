#!/usr/bin/env bash
# maps_selftest.sh ROOT: checks that maps.sh names a file, a folder and a step that are wrong in a copy of the maps.
set -euo pipefail
checker=$(dirname "$0")/maps.sh
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

fresh() {
  rm -rf "${copy:?}"/*
  cp -R "$1"/{README.md,CONTRIBUTING.md,docs,host,scripts,tests,bench,kernels} "$copy"
}
refuses() {  # MESSAGE
  local output
  if output=$("$checker" "$copy"); then
    echo "not noticed: $1"
    exit 1
  fi
  [[ $output == *"$1"* ]] || { echo "noticed, but not as '$1': $output"; exit 1; }
}

fresh "$1"
"$checker" "$copy" >/dev/null || { echo 'refused the maps as they are'; exit 1; }
mv "$copy/host/moclean/run/engine.cpp" "$copy/host/moclean/run/other.cpp"
refuses 'CONTRIBUTING.md: there is no host/moclean/run/engine.cpp'
fresh "$1"
echo 'See `run/no_such_file.hpp`.' >>"$copy/docs/architecture.md"
refuses 'docs/architecture.md: there is no run/no_such_file.hpp'
fresh "$1"
mkdir "$copy/host/moclean/attic"
refuses 'README.md: the map leaves out host/moclean/attic'
fresh "$1"
mv "$copy/bench" "$copy/benches"
refuses 'README.md: there is no bench/'
fresh "$1"
sed -i '/^14[.] /p' "$copy/CONTRIBUTING.md"
refuses 'the walk has 15 files'
echo 'maps: what is wrong in them is named'
