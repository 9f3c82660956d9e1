#!/usr/bin/env bash
# kernels_compile_selftest.sh KERNELS FLAG...: checks that kernels_compile.sh refuses a kernel with a
# type error, a missing definition, and a barrier where none may be.
set -euo pipefail
checker=$(dirname "$0")/kernels_compile.sh
kernels=$1
shift
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
cp "$kernels/prelude.cl" "$planted"

echo 'kernel void sound(global real* x) { x[get_global_id(0)] = 0; }' >"$planted/sound.cl"
"$checker" "$planted" "$@" >/dev/null || { echo 'refused a sound kernel'; exit 1; }
if "$checker" "$planted" >/dev/null 2>&1; then echo 'accepted a prelude without REAL'; exit 1; fi

echo 'kernel void broken(global real* x) { x = 1.5; }' >"$planted/broken.cl"
if "$checker" "$planted" "$@" >/dev/null 2>&1; then echo 'accepted a broken kernel'; exit 1; fi

echo 'kernel void waits(global real* x) { barrier(CLK_LOCAL_MEM_FENCE); x[0] = 1; }' >"$planted/waits_group.cl"
rm "$planted/broken.cl"
"$checker" "$planted" "$@" >/dev/null || { echo 'refused a barrier in a file for groups'; exit 1; }
mv "$planted/waits_group.cl" "$planted/waits.cl"
if "$checker" "$planted" "$@" >/dev/null 2>&1; then echo 'accepted a barrier elsewhere'; exit 1; fi
echo 'kernels: a broken kernel is refused'
