"""Runs the built programs for benchmarks."""
import contextlib
import json
import math
import os
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

from .flights import FRAMES_PER_SECOND

ROOT = Path(__file__).resolve().parents[3]
BIN = ROOT / "build/release/bin"
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "meridian"
EARTH = [str(ROOT / "data/assets" / name) for name in ("sun.asset", "earth.asset")]


class Failed(Exception):
    """A benchmark that gives no figure, and why."""


def run(program, *arguments, stdin="", environment=None, timeout=1800, remedy="build it", accepted=(0,)):
    """Runs a program of the build with that text to read; its standard output, if it ends with an accepted code."""
    path = BIN / program
    if not path.exists():
        raise Failed(f"build/release/bin/{program}: no such program; {remedy}")
    try:
        done = subprocess.run([path, *map(str, arguments)], env=environment, timeout=timeout, text=True,
                              input=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    except subprocess.TimeoutExpired:
        raise Failed(f"{program}: not done after {timeout} s") from None
    if done.returncode not in accepted:
        lines = (done.stderr or done.stdout).strip().splitlines()
        raise Failed(f"{program}: exit {done.returncode}: {lines[-1] if lines else 'no message'}")
    return done.stdout


def read_json(text, where):
    try:
        return json.loads(text)
    except ValueError as error:
        raise Failed(f"{where}: no JSON: {error}") from None


def play(recording, environment=None):
    """Flies a Recording over the Earth off screen, from a settled first frame and with frames as far apart as on a screen,
    so that tiles have as long to arrive; the figures of --stats."""
    with tempfile.TemporaryDirectory(prefix="meridian-bench-") as folder:
        flight = Path(folder, "flight.osrectxt")
        recording.write(flight)
        text = run("bench-flight", "--play", flight, "--frames", len(recording.poses), "--fps", FRAMES_PER_SECOND,
                   environment=environment)
    stats = read_json(text, "bench-flight")
    if stats["frames"] != len(recording.poses):
        raise Failed(f"bench-flight drew {stats['frames']} frames instead of {len(recording.poses)}")
    return stats


def percentile(values, percent):
    """By nearest rank."""
    ordered = sorted(values)
    return ordered[max(math.ceil(percent / 100 * len(ordered)), 1) - 1]


def ratio_to_median(frames, replays):
    """Each frame's time over the median of the same frame's in the replays."""
    return [frame / statistics.median(same) for frame, *same in zip(frames, *replays)]


@contextlib.contextmanager
def empty_shader_cache():
    """An environment whose ${CACHE} holds the prepared data and nothing else."""
    with tempfile.TemporaryDirectory(prefix="meridian-bench-", dir=_made(CACHE.parent)) as folder:
        data = Path(folder, "meridian/data")
        data.mkdir(parents=True)
        for file in (CACHE / "data").glob("*.tif"):
            try:
                os.link(file, data / file.name)
            except OSError:
                shutil.copy2(file, data / file.name)
        environment = {**os.environ, "XDG_CACHE_HOME": folder}
        # The program sets it below ${CACHE}, unless the user did.
        environment.pop("MESA_SHADER_CACHE_DIR", None)
        yield environment


def _made(folder):
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def drop_data_from_memory():
    """Makes the kernel forget the prepared data, so that the next reader waits for the disk."""
    files = sorted((CACHE / "data").glob("*.tif"))
    if not files:
        raise Failed(f"{CACHE / 'data'}: no prepared data; run scripts/lib/prepare-data")
    for file in files:
        with open(file, "rb") as stream:
            os.fsync(stream.fileno())
            os.posix_fadvise(stream.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
