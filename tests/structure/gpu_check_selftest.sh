#!/usr/bin/env bash
# gpu_check_selftest.sh CHECKER KERNELS: checks that scripts/gpu-check accepts a sound kernel and
# refuses one with a private array, one with too much local memory, and one that does not compile.
set -euo pipefail
checker=$1
kernels=$2
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
cp "$kernels/prelude.cl" "$planted"

accepts() { "$checker" --kernels "$planted" >/dev/null 2>&1; }

echo 'kernel void planted(global real* x) { x[get_global_id(0)] *= 2; }' >"$planted/planted.cl"
accepts || { status=$?; ((status == 77)) && exit 77; echo 'refused a sound kernel'; exit 1; }

cat >"$planted/planted.cl" <<'KERNEL'
kernel void planted(global real* x, global const int* order) {
  real copy[64];
  for (int i = 0; i < 64; ++i) copy[order[i] & 63] = x[i];
  x[get_global_id(0)] = copy[order[0] & 63];
}
KERNEL
if accepts; then echo 'accepted a private array'; exit 1; fi

cat >"$planted/planted.cl" <<'KERNEL'
kernel void planted(global real* x) {
  local real shared[6145];
  for (int i = get_local_id(0); i < 6145; i += WG) shared[i] = x[i];
  barrier(CLK_LOCAL_MEM_FENCE);
  x[get_global_id(0)] = shared[6144 - get_local_id(0)];
}
KERNEL
if accepts; then echo 'accepted more than 48 KiB of local memory'; exit 1; fi

echo 'kernel void planted(global real* x) { x = 1.5; }' >"$planted/planted.cl"
if accepts; then echo 'accepted a kernel that does not compile'; exit 1; fi
echo 'gpu-check: refuses what it should'
