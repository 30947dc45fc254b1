# Shared by the scripts; to be sourced. Strict: an unset variable or a failing command ends the script.
# shellcheck shell=bash
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
: "${HOME:=$(getent passwd "$(id -u)" | cut -d: -f6)}"
export HOME

say() { printf '== %s\n' "$*"; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}
wrong_usage() {
  printf '%s: %s; try --help\n' "$(basename "$0")" "$*" >&2
  exit 2
}

# The comment at the top of the calling script, which is its help.
print_help() { sed -n '2,${/^#/!q;s/^# \{0,1\}//;p}' "$0"; }

# The host's ${CACHE}. Prepared data live in its folder data.
cache_folder() { printf '%s/meridian\n' "${XDG_CACHE_HOME:-$HOME/.cache}"; }

# Whether that program can open a window; says why not. A display may be named and be gone, or not be ours (sudo).
opens_window() {
  local program=$1 nothing answer
  if [[ -z ${DISPLAY-} && -z ${WAYLAND_DISPLAY-} ]]; then
    say "no display"
    return 1
  fi
  nothing=$(mktemp --suffix .asset)
  answer=$("$program" "$nothing" --frames 1 --size 16x16 --log warning 2>&1) || true
  rm -f "$nothing"
  [[ $answer == *"there is no window"* ]] || return 0
  say "no window: $answer"
  return 1
}

# Packages of the named groups of packages.txt.
packages_of() {
  local group
  for group; do
    awk -v group="$group" '$1 == group { print $2 }' "$root/scripts/lib/packages.txt"
  done
}

is_installed() {
  local status
  status=$(dpkg-query --show --showformat '${db:Status-Status}' "$1" 2>/dev/null) && [[ $status == installed ]]
}

# Installs what is missing of the named groups. Calls apt only if something is.
install_packages() {
  local package missing=() as_root=()
  command -v dpkg-query >/dev/null || die "this is no Debian; install by hand what scripts/lib/packages.txt names"
  while read -r package; do
    is_installed "$package" || missing+=("$package")
  done < <(packages_of "$@")
  ((${#missing[@]})) || return 0
  say "installing ${#missing[@]} packages: ${missing[*]}"
  if (($(id -u) != 0)); then
    command -v sudo >/dev/null || die "needs root or sudo to install: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600)
  "${as_root[@]}" update </dev/null
  "${as_root[@]}" install --yes --no-install-recommends "${missing[@]}" </dev/null
}

# Configures the preset, unless that is done: Ninja itself notices changed CMake files, but neither changed presets nor
# libraries installed since.
configure() {
  local preset=$1 ninja_file=$root/build/$1/build.ninja
  [[ -e $ninja_file && $ninja_file -nt $root/CMakePresets.json && $ninja_file -nt /var/lib/dpkg/status ]] && return 0
  say "configuring $preset"
  (cd "$root" && cmake --preset "$preset")
}

# build PRESET [TARGET...]: everything if no target is named.
build() {
  local preset=$1
  shift
  configure "$preset"
  say "building $preset"
  NINJA_STATUS='[%f/%t, %es] ' cmake --build "$root/build/$preset" --parallel "$(nproc)" ${1:+--target "$@"}
}
