#!/usr/bin/env bash
# gpu_check.sh CHECKER: every kernel compiles for GPUs, without spills or private stack.
exec "$1"
