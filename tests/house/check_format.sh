#!/usr/bin/env bash
# Every source is as clang-format 14 leaves it.
#
# usage: check_format.sh ROOT CLANG_FORMAT
set -euo pipefail
cd "$1"
find host modules tests \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 "$2" --dry-run -Werror
