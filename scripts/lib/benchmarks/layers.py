"""Layers: what a frame costs with many, fading, toggling, loading. `scripts/bench --list` says what each is."""
import functools

from .programs import read_json, run
from .registry import AT_MOST, benchmark


@functools.lru_cache(maxsize=None)
def layers():
    return read_json(run("bench-layers"), "bench-layers")


@benchmark("layers-8-over-1", "x one", AT_MOST, 1.15)
def eight_over_one():
    """Median frame of the settled Earth seen from 20 000 km with 8 of 50 colour layers enabled, over that with one; in
    turn, in one process."""
    return layers()["eight_ms"] / layers()["one_ms"]


@benchmark("layers-fading", "x one", AT_MOST, 2)
def fading():
    """Median frame while the uppermost of these 8 fades out and in again within 60 frames each, over that with one
    layer."""
    return layers()["fading_ms"] / layers()["one_ms"]


@benchmark("toggle-50-frames", "frames", AT_MOST, 2)
def toggle_frames():
    """Frames until something of one more layer is seen after it was enabled: 50 layers, 8 enabled, its tiles and
    program cached; the most of 5."""
    return layers()["toggle_frames"]


@benchmark("toggle-50-seconds", "s", AT_MOST, 1)
def toggle_seconds():
    """Seconds until all of the view shows it; the most of 5."""
    return layers()["toggle_s"]


@benchmark("load-500-seconds", "s", AT_MOST, 2)
def load_seconds():
    """An asset with a globe of 500 layers, half files and half map services, none enabled: loading it, and a frame."""
    return layers()["load_s"]


@benchmark("load-500-takes", "handles", AT_MOST, 0)
def load_takes():
    """Threads, open files and requests for tiles that this takes together."""
    return layers()["load_takes"]
