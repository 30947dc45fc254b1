"""A map service's times, played back. `scripts/bench --list` says what each is."""
import functools

from .programs import read_json, run
from .registry import AT_LEAST, AT_MOST, benchmark

STEPS_PER_SECOND = 10


@functools.lru_cache(maxsize=None)
def playback(seconds):
    text = run("bench-playback", "--seconds", seconds, "--rate", STEPS_PER_SECOND, "--size", "640x360")
    return read_json(text, "bench-playback")


@benchmark("playback-steps-shown", "x asked", AT_LEAST, 0.8)
def playback_steps_shown():
    """Steps in time that the pictures show in a minute, over those asked for: 10 a second of a WMTS that is static files
    on a local nginx, 640 x 360."""
    return playback(60)["shown_per_second"] / STEPS_PER_SECOND


@benchmark("playback-bad-frames", "frames", AT_MOST, 0)
def playback_bad_frames():
    """Frames of that minute whose picture is blank somewhere on the globe, or shows two times at once."""
    return playback(60)["blank_frames"] + playback(60)["mixed_frames"]


@benchmark("playback-memory-growth", "MiB", AT_MOST, 64)
def playback_memory_growth():
    """Greatest resident memory after the first quarter of that minute, less the greatest within it."""
    return playback(60)["memory_growth_mib"]


@benchmark("playback-memory-growth-long", "MiB", AT_MOST, 64, long=True)
def playback_memory_growth_long():
    """The same of ten minutes."""
    return playback(600)["memory_growth_mib"]
