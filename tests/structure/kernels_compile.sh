#!/usr/bin/env bash
# kernels_compile.sh KERNELS FLAG...: checks every file with kernels after the prelude with clang, which
# needs no device. Warnings are errors.
set -euo pipefail
kernels=$1
shift

status=0 count=0
for kernel in "$kernels"/*.cl; do
  grep -q '^kernel ' "$kernel" || continue  # is there to be included
  count=$((count + 1))
  clang-14 -x cl -cl-std=CL1.2 -target spir64 -Xclang -finclude-default-header -fsyntax-only \
    -Wall -Wextra -Werror "$@" -include "$kernels/prelude.cl" "$kernel" ||
    { echo "$kernel: does not compile with $*"; status=1; }
done
((count > 0)) || { echo "kernels: none in $kernels"; exit 1; }
((status == 0)) && echo "kernels: $count files compile"
exit "$status"
