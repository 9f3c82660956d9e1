#!/usr/bin/env bash
# maps.sh ROOT: checks that what the maps for newcomers name exists: the map of README.md, the walk in
# CONTRIBUTING.md, docs/architecture.md; that the map names every folder of the library; and that the walk is
# short. Names what is missing and exits 1.
set -euo pipefail
cd "$1"
longest_walk=14

problems=0
problem() { echo "$1"; problems=$((problems + 1)); }

# The lines of a section: FILE HEADING.
section() { awk -v heading="## $2" '/^## / { inside = $0 == heading } inside' "$1"; }

# Words with a slash inside or at their end, as people write paths: below the root or a folder of it that
# the text is about.
require_paths() {  # WHERE, the text on standard input
  local path folder found=0
  while read -r path; do
    found=$((found + 1))
    for folder in . host host/moclean host/cli tests bench; do
      [[ -e $folder/$path ]] && continue 2
    done
    problem "$1: there is no $path"
  done < <(grep -oE '[A-Za-z0-9_.-]+/([A-Za-z0-9_.-]+/)*([A-Za-z0-9_-]+([.][a-z]+)?)?' | sort -u)
  ((found > 0)) || problem "$1: names no file or folder"
}

map=$(section README.md 'Map of the tree')
walk=$(section CONTRIBUTING.md 'A walk' | grep -E '^[0-9]+[.] ' || true)
require_paths README.md < <(awk '/^```/ { fence = !fence; next } fence' <<<"$map")
require_paths CONTRIBUTING.md < <(grep -oE '^[0-9]+[.] `[^`]+`' <<<"$walk")
require_paths docs/architecture.md < <(grep -oE '`[^` (]+`' docs/architecture.md)

for folder in host/moclean/*/; do
  folder=${folder%/}
  grep -qw -- "${folder##*/}" <<<"$map" || problem "README.md: the map leaves out $folder"
done
steps=$(wc -l <<<"$walk")
((steps <= longest_walk)) || problem "CONTRIBUTING.md: the walk has $steps files, at most $longest_walk"

((problems == 0)) || { echo "maps: $problems problems"; exit 1; }
echo "maps: all that is named exists; the walk has $steps files"
