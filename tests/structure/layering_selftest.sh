#!/usr/bin/env bash
# layering_selftest.sh ROOT: plants one violation after another in a copy of the sources and checks
# that layering.sh names each, and that it accepts what only looks like one.
set -euo pipefail
checker=$(dirname "$0")/layering.sh
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cp -R "$1/host" "$copy/host"

failures=0

# refuses FILE LINE MESSAGE: the checker must fail and name the file with the message.
refuses() {
  local file=$copy/host/$1 output
  mkdir -p "${file%/*}"
  printf '%s\n' "$2" >"$file"
  if output=$("$checker" "$copy"); then
    echo "not noticed in $1: $2"
    failures=$((failures + 1))
  elif [[ $output != *"host/$1:"*"$3"* ]]; then
    echo "noticed, but not as '$3' in $1: $output"
    failures=$((failures + 1))
  fi
  rm "$file"
}

accepts() {
  local file=$copy/host/$1 output
  printf '%s\n' "$2" >"$file"
  output=$("$checker" "$copy") || {
    echo "refused in $1: $2: $output"
    failures=$((failures + 1))
  }
  rm "$file"
}

refuses moclean/core/planted.hpp '#include "moclean/motion/recording.hpp"' 'may only include: itself'
refuses moclean/motion/planted.cpp '  #  include "moclean/formats/read_write.hpp"' 'may only include: moclean/core'
refuses moclean/solve/planted.hpp '#include "moclean/motion/recording.hpp"' 'may only include'
refuses moclean/methods/robust_pca/planted.hpp '#include "moclean/linalg/batch.hpp"' 'may only include'
refuses moclean/methods/robust_pca/reference_planted.cpp '#include "moclean/device/device.hpp"' 'may only include'
refuses moclean/methods/robust_pca/reference_planted.cpp '#include "moclean/methods/robust_pca/opencl.hpp"' 'may only include'
refuses moclean/methods/matrix_normal/reference_planted.cpp '#include "moclean/methods/matrix_normal/window.hpp"' 'is to check'
refuses moclean/methods/matrix_normal/reference_planted.cpp '#include "moclean/methods/matrix_normal/deviation.hpp"' 'is to check'
refuses moclean/methods/robust_pca/opencl_planted.cpp '#include "moclean/backend/backend.hpp"' 'may only include'
refuses moclean/methods/robust_pca/planted.hpp '#include "moclean/methods/spectral/weights.hpp"' 'of another method'
refuses moclean/metric/planted.cpp '#include "moclean/elsewhere/x.hpp"' 'in no folder of the table'
refuses moclean/elsewhere/planted.cpp 'int x;' 'in no folder of the table'
refuses moclean/linalg/planted.cpp '#include <CL/opencl.hpp>' 'includes OpenCL'
refuses moclean/device/planted.cpp '#include <clblast.h>' 'includes CLBlast'
refuses moclean/noise/planted.cpp '#include <fstream>' 'opens a file'
refuses moclean/noise/planted.cpp 'std::FILE* f = std::fopen("a", "r");' 'opens a file'
refuses moclean/formats/planted.cpp 'void f() { std::cerr << 1; }' 'prints'
refuses moclean/formats/planted.cpp 'void f() { std::printf("x"); }' 'prints'
refuses moclean/formats/planted.cpp 'void f() { fmt::print("x"); }' 'prints'
refuses moclean/solve/planted.cpp 'void f() { std::exit(1); }' 'ends the program'
refuses moclean/formats/planted.cpp '  } catch (const std::exception&) {' 'catches'
refuses moclean/core/planted.cpp "$(printf 'int x;\n%.0s' {1..401})" 'has 401 lines'

accepts moclean/core/planted.cpp '// a comment may say std::cout, catch (...) or #include <CL/opencl.hpp>'
accepts moclean/formats/planted.cpp 'int n = std::snprintf(nullptr, 0, "x");'
accepts moclean/formats/planted.cpp '#include <fstream>'
accepts moclean/solve/opencl/planted.cpp '#include "moclean/linalg/x.hpp"'
accepts moclean/methods/robust_pca/opencl_planted.cpp '#include "moclean/linalg/x.hpp"'

((failures == 0)) || exit 1
echo 'layering: every planted violation is named'
