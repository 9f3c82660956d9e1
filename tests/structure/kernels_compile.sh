#!/usr/bin/env bash
# kernels_compile.sh KERNELS FLAG...: checks every file with kernels after the prelude with clang, which
# needs no device. Warnings are errors. Only files NAME_group.cl may have barriers: what runs their kernels
# is tested with every way PoCL can map work-groups (tests/device_tests.cmake).
set -euo pipefail
kernels=$1
shift

status=0 count=0
mapfile -t files < <(find "$kernels" -name '*.cl' | sort)
for kernel in "${files[@]}"; do
  grep -q '^kernel ' "$kernel" || continue  # is there to be included
  count=$((count + 1))
  clang-14 -x cl -cl-std=CL1.2 -target spir64 -Xclang -finclude-default-header -fsyntax-only \
    -Wall -Wextra -Werror -I "$kernels" "$@" -include "$kernels/prelude.cl" "$kernel" ||
    { echo "$kernel: does not compile with $*"; status=1; }
done
for kernel in "${files[@]}"; do
  [[ $kernel != *_group.cl ]] && grep -Hn '^[^/]*barrier(' "$kernel" &&
    { echo "$kernel: has a barrier; name it NAME_group.cl"; status=1; }
done
((count > 0)) || { echo "kernels: none in $kernels"; exit 1; }
((status == 0)) && echo "kernels: $count files compile"
exit "$status"
