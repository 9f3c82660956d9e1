#!/usr/bin/env bash
# layering.sh ROOT: checks who may include whom, and a few things only one folder may do.
# Names every offending line as `file:line: ...` and exits 1 if there is one.
set -euo pipefail
cd "$1"

# What a folder may include besides itself. The longest matching folder is a file's home, and an
# include's too. `*` is everything. Of the folder of a method, methods/X, the files reference* and
# opencl* are rooms of their own, moclean/methods/reference and .../opencl, whatever the method.
declare -A may_include=(
  [moclean/core]=''
  [moclean/motion]='moclean/core'
  [moclean/body]='moclean/core moclean/motion'
  [moclean/formats]='moclean/core moclean/motion'
  [moclean/noise]='moclean/core moclean/motion'
  [moclean/segment]='moclean/core moclean/motion'
  [moclean/metric]='moclean/core moclean/motion'
  [moclean/filter]='moclean/core moclean/motion'
  [moclean/device]='moclean/core'
  [moclean/linalg]='moclean/core moclean/device'
  [moclean/solve]='moclean/core'
  [moclean/solve/opencl]='moclean/core moclean/device moclean/linalg moclean/solve'
  [moclean/methods]='moclean/core moclean/solve'
  [moclean/methods/reference]='moclean/core moclean/solve moclean/methods'
  [moclean/methods/opencl]='moclean/core moclean/device moclean/linalg moclean/solve moclean/solve/opencl moclean/methods'
  [moclean/backend]='moclean/core moclean/device moclean/linalg moclean/solve moclean/solve/opencl moclean/methods moclean/methods/reference moclean/methods/opencl'
  [moclean/denoise]='moclean/core moclean/motion moclean/body moclean/segment moclean/filter moclean/solve moclean/methods moclean/backend'
  [moclean/experiment]='moclean/core moclean/motion moclean/formats moclean/noise moclean/metric moclean/denoise moclean/backend'
  [moclean/report]='moclean/core moclean/motion moclean/metric moclean/denoise'
  [moclean/run]='moclean/core moclean/motion moclean/formats moclean/segment moclean/filter moclean/linalg moclean/solve moclean/backend moclean/metric moclean/denoise moclean/report'
  [cli]='*'
  [python]='*'
)

# What only some folders may do: pattern (awk), folders, what the line does.
only_in=(
  '#include <CL/|moclean/device|includes OpenCL'
  '#include <clblast|moclean/linalg|includes CLBlast'
  'matrix_normal/(window|deviation)[.]hpp"|moclean/methods moclean/methods/opencl|includes what the reference is to check'
  'fstream|fopen[(]|moclean/formats cli|opens a file'
  'std::(cout|cerr|clog)|#include <iostream>|(^|[^a-z_])(f?printf|f?puts)[(]|fmt::print|cli|prints'
  '(^|[^a-z_])(exit|_Exit|quick_exit|abort|terminate)[(]|cli|ends the program'
  '(^|[^a-z_])catch [(]|cli|catches'
)

# Files that may catch: `file: reason`.
may_catch=(
  'moclean/device/opencl.hpp: turns cl::Error into DeviceError'
  'moclean/device/kernel.cpp: turns a failed build into a DeviceError that holds the log'
  'moclean/formats/file.cpp: says of which file that it does not fit into the memory'
  'moclean/device/device.cpp: an ICD without platforms or devices throws; that is an empty list'
  'moclean/experiment/toml_file.cpp: turns what toml++ asserts of a file into an error with its line'
  'moclean/experiment/grid_config.cpp: gives the error of a specification its file and line'
  'moclean/core/parallel.hpp: carries an exception from a thread to the caller'
  'moclean/run/run_log.hpp: keeps the failure of a take, which need not end the run'
  'moclean/run/engine.cpp: names the file of a take that a method refuses, and solves alone what fails together'
  'moclean/run/inputs.cpp: an .amc without a skeleton is for its reader to report'
  'moclean/run/take_reader.cpp: carries what reading a take threw to who asks for the take'
  'moclean/run/result_writer.cpp: carries the first exception of its threads to the caller'
  'moclean/solve/opencl/concurrent.cpp: carries the first exception of its threads to the caller'
)

max_lines=400
problems=0
problem() { echo "$1"; problems=$((problems + 1)); }

# Sets `home` to the longest folder of the table that holds the path.
home_of() {
  home=${1%/*}
  [[ $1 =~ ^(moclean/methods)/[^/]+/(reference|opencl) ]] && home=${BASH_REMATCH[1]}/${BASH_REMATCH[2]}
  while [[ ! -v may_include[$home] && $home == */* ]]; do home=${home%/*}; done
  [[ -v may_include[$home] ]]
}

check_include() {  # FILE LINE INCLUDED
  local from to
  home_of "$1" || return 0  # reported once, for the file
  from=$home
  [[ ${may_include[$from]} == '*' ]] && return 0
  if ! home_of "$3"; then
    problem "host/$1:$2: includes $3, which is in no folder of the table in layering.sh"
    return 0
  fi
  to=$home
  if [[ $from == moclean/methods* && $to == moclean/methods* && ${1%/*} != "${3%/*}" ]]; then
    problem "host/$1:$2: includes $3, of another method"
  fi
  [[ $from == "$to" || " ${may_include[$from]} " == *" $to "* ]] ||
    problem "host/$1:$2: includes $3, but $from may only include: ${may_include[$from]:-itself}"
}

check_rule() {  # PATTERN FOLDERS DEED
  local file line
  while IFS=: read -r file line; do
    home_of "$file" || continue
    [[ " $2 " == *" $home "* ]] && continue
    [[ $3 == catches && " ${may_catch[*]%%:*} " == *" $file "* ]] && continue
    problem "host/$file:$line: $3, but only $2 may"
  done < <(awk -v pattern="$1" '{ code = $0; sub(/\/\/.*/, "", code) }
                                code ~ pattern { print FILENAME ":" FNR }' "${sources[@]}")
}

pushd host >/dev/null
mapfile -t sources < <(find . -name '*.hpp' -o -name '*.cpp' | sed 's|^\./||' | sort)
((${#sources[@]} > 0)) || { echo "layering: no sources under $1/host"; exit 1; }

for file in "${sources[@]}"; do
  home_of "$file" || problem "host/$file:1: is in no folder of the table in layering.sh"
done
while IFS=: read -r file line included; do
  check_include "$file" "$line" "$included"
done < <(awk -F'"' '/^[ \t]*#[ \t]*include[ \t]*"/ { print FILENAME ":" FNR ":" $2 }' "${sources[@]}")
for rule in "${only_in[@]}"; do
  deed=${rule##*|} rest=${rule%|*}
  check_rule "${rest%|*}" "${rest##*|}" "$deed"
done
for exception in "${may_catch[@]}"; do
  grep -qs 'catch (' "${exception%%:*}" ||
    problem "layering.sh: lets host/${exception%%:*} catch, which it does not do"
done
popd >/dev/null

while read -r lines file; do
  ((lines <= max_lines)) || problem "$file:$max_lines: has $lines lines, at most $max_lines are allowed"
done < <(find host kernels tests bench cmake scripts -type f 2>/dev/null -exec wc -l {} \;)

((problems == 0)) || { echo "layering: $problems problems"; exit 1; }
echo "layering: ${#sources[@]} files keep to the table"
