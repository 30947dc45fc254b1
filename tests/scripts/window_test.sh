#!/usr/bin/env bash
# What scripts/run goes by when it chooses between a window and the flight off screen.
#
# usage: window_test.sh PROGRAM [--here]
#   --here   only whether a window opens on the display that is set

# shellcheck source=../../scripts/lib/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib/common.sh"

program=$1
if [[ ${2-} == --here ]]; then
  opens_window "$program"
  exit
fi
unset DISPLAY WAYLAND_DISPLAY

expect_none() {
  local said
  if said=$(opens_window "$program"); then
    die "a window without a display ($1)"
  fi
  [[ $said == *"$2"* ]] || die "$1: says '$said', not '$2'"
}
expect_none "no display" "no display"
DISPLAY=:987 expect_none "a display that is gone" ":987"

if command -v xvfb-run >/dev/null; then
  xvfb-run --auto-servernum --server-args '-screen 0 640x480x24' "$0" "$program" --here ||
    die "no window on a display that is there"
else
  say "no xvfb-run: a display that is there was not tried"
fi
