#!/usr/bin/env bash
# Compiles a source that holds one #include line, with the include folders of a room.
#
# usage: compile_include.sh COMPILER HEADER MESSAGE FOLDER...
#   MESSAGE   what the compiler must complain of; none: it must compile
set -euo pipefail
compiler=$1 header=$2 message=$3
shift 3
compiled=yes
output=$(printf '#include "%s"\n' "$header" |
  LC_ALL=C "$compiler" -std=c++20 -fsyntax-only -x c++ "${@/#/-I}" - 2>&1) || compiled=no
if [[ $message == none ]]; then
  [[ $compiled == yes ]] && exit 0
  printf '#include "%s" should compile:\n%s\n' "$header" "$output"
else
  [[ $compiled == no && $output == *"$message"* ]] && exit 0
  printf '#include "%s" should fail with "%s"; compiled: %s\n%s\n' "$header" "$message" "$compiled" "$output"
fi
exit 1
