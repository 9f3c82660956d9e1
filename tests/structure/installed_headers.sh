#!/usr/bin/env bash
# installed_headers.sh INCLUDE: checks that every header below the folder finds there the headers of ours that
# it includes: with the test `headers`, that it compiles where moclean is installed. Names each that is missing.
set -euo pipefail
cd "$1"

problems=0 count=0
while IFS=: read -r file line included; do
  count=$((count + 1))
  [[ -e $included ]] && continue
  echo "$file:$line: includes $included, which is not installed"
  problems=$((problems + 1))
done < <(grep -rn '^#include "' --include='*.hpp' . | sed -E 's|^\./||; s|#include "([^"]*)".*|\1|')
((count > 0)) || { echo "installed headers: no include under $1"; exit 1; }
((problems == 0)) || { echo "installed headers: $problems includes are missing"; exit 1; }
echo "installed headers: all $count includes are there"
