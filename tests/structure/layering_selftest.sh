#!/usr/bin/env bash
# layering_selftest.sh ROOT: plants violations in a copy of the sources and checks that layering.sh names each, and
# that it accepts what only looks like one. All of a kind are planted at once: a run takes seconds.
set -euo pipefail
checker=$(dirname "$0")/layering.sh
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
cp -R "$1/host" "$copy/host"

failures=0
planted=() expected=() texts=()

# plant FILE LINE: in a file of its own beside others of that name.
plant() {
  local name=${1%.*}_${#planted[@]}.${1##*.}
  planted+=("$name") texts+=("$2")
  mkdir -p "$copy/host/${name%/*}"
  printf '%s\n' "$2" >"$copy/host/$name"
}

# refuses FILE LINE MESSAGE: the checker must fail and name the file with the message.
refuses() { plant "$1" "$2"; expected+=("$3"); }

accepts() { plant "$1" "$2"; }

# Runs the checker and removes what was planted.
check() {
  output=$("$checker" "$copy") && result=0 || result=1
  for name in "${planted[@]}"; do rm "$copy/host/$name"; done
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

check
((result != 0)) || { echo 'nothing was noticed'; failures=1; }
for i in "${!planted[@]}"; do
  lines=$(grep -F "host/${planted[i]}:" <<<"$output") || true
  [[ $lines == *"${expected[i]}"* ]] && continue
  echo "not noticed as '${expected[i]}' in ${planted[i]}: ${texts[i]}: $lines"
  failures=$((failures + 1))
done
planted=() texts=()

accepts moclean/core/planted.cpp '// a comment may say std::cout, catch (...) or #include <CL/opencl.hpp>'
accepts moclean/formats/planted.cpp 'int n = std::snprintf(nullptr, 0, "x");'
accepts moclean/formats/planted.cpp '#include <fstream>'
accepts moclean/solve/opencl/planted.cpp '#include "moclean/linalg/x.hpp"'
accepts moclean/methods/robust_pca/opencl_planted.cpp '#include "moclean/linalg/x.hpp"'

check
((result == 0)) || { echo "refused what is right: $output"; failures=$((failures + 1)); }

((failures == 0)) || exit 1
echo 'layering: every planted violation is named'
