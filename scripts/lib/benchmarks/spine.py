"""The spine: frame time, streaming, toggling, selection, memory, start. `scripts/bench --list` says what each is."""
import functools
import json
import os
import statistics
import tempfile
import time
from pathlib import Path

from . import flights
from .programs import (EARTH, Failed, drop_data_from_memory, empty_shader_cache, percentile, play,
                       ratio_to_median, read_json, run)
from .registry import AT_LEAST, AT_MOST, benchmark

MIB = 1 << 20
# docs/architecture.md, Sizes and budgets: tile cache, texture pool, GDAL's cache; and what the program itself may take.
MEMORY_LIMIT_MIB = 512 + 512 + 64 + 300

PLACES = {"orbit": "20,10,20000000", "100km": "46.5,8,100000", "2km": "44.9,9.4,2000"}


@functools.lru_cache(maxsize=None)
def frame_floor(place):
    text = run("bench-frame-floor", "--camera", PLACES[place])
    return read_json(text, "bench-frame-floor")


@benchmark("frame-floor-orbit", "x floor", AT_MOST, 1.3)
def frame_floor_orbit():
    """Median frame of the settled Earth seen from 20 000 km, over that of one draw of as many triangles, textures and
    texels with the same program, framebuffer and blit."""
    return frame_floor("orbit")["ratio"]


@benchmark("frame-floor-100km", "x floor", AT_MOST, 1.3)
def frame_floor_100km():
    """The same from 100 km above the Alps."""
    return frame_floor("100km")["ratio"]


@benchmark("frame-floor-2km", "x floor", AT_MOST, 1.3)
def frame_floor_2km():
    """The same from 2 km above the ellipsoid, over the edge of the Apennines."""
    return frame_floor("2km")["ratio"]


@benchmark("pixels-per-triangle", "pixels", AT_LEAST, 60)
def pixels_per_triangle():
    """Covered pixels per triangle drawn, skirts excluded: the least of the three places of frame-floor."""
    return min(frame_floor(place)["pixels_per_triangle"] for place in PLACES)


@benchmark("geometric-error", "pixels", AT_MOST, 0.5)
def geometric_error():
    """Greatest distance on screen from the surface with a grid four times denser: the most of the three places."""
    return max(frame_floor(place)["error_pixels"] for place in PLACES)


def orbit_median():
    recording = flights.Recording()
    flown = recording.fly(flights.orbit_to_1000_km(200))
    return statistics.median(play(recording)["per_frame"]["frame_ms"][flown])


def marble_median():
    lines = [f"{latitude!r} {longitude!r} {radius}" for latitude, longitude, radius in flights.outlines_to_1000_km(200)]
    with tempfile.TemporaryDirectory(prefix="meridian-bench-") as folder:
        text = run("bench-marble", stdin="\n".join(lines), environment={**os.environ, "XDG_DATA_HOME": folder},
                   remedy="install libmarble-dev and build again")
    return read_json(text, "bench-marble")["median_ms"]


@benchmark("orbit-to-1000km-median-ms", "ms", AT_MOST, 16)
def orbit_to_1000_km():
    """Median frame of 200 from 20 000 km to 1000 km, with relief, tiles streaming in. Peers on the same flight without
    relief: osgEarth 43 to 63, CesiumJS 77 to 86."""
    return orbit_median()


@benchmark("orbit-over-marble", "x Marble", AT_MOST, 2.3, needs=("peers",))
def orbit_over_marble():
    """The same over the median of Marble's software globe, with all its tiles at hand and no relief or light, flown in
    turns: 16 ms over the 7 that it took on the machine that the goal was set on."""
    ours, marble = [], []
    for _ in range(3):
        ours.append(orbit_median())
        marble.append(marble_median())
    return statistics.median(ours) / statistics.median(marble)


@benchmark("streaming-flight-p99", "x warm", AT_MOST, 2)
def streaming_flight():
    """A flight with cold memory caches, then four times warm, in one process. Each frame is taken relative to the
    median of the same frame in three warm replays; the p99 of the cold flight, over that of the fourth replay."""
    poses = flights.descent_to_the_alps(300)
    recording = flights.Recording()
    passes = []
    for _ in range(5):
        recording.hold(poses[0], 30)
        passes.append(recording.fly(poses))
    frames = play(recording)["per_frame"]["frame_ms"]
    cold, *replays, fourth = (frames[part] for part in passes)
    return percentile(ratio_to_median(cold, replays), 99) / percentile(ratio_to_median(fourth, replays), 99)


def toggles(count, every):
    """Scripts that turn two layers on and off in turn, so that all four combinations come up."""
    layer = "Scene.Earth.Renderable.Layers.ColorLayers."
    steps = [("Precipitation", "true"), ("Temperature", "true"), ("Precipitation", "false"), ("Temperature", "false")]
    return [(every // 2 + every * number,
             f'openspace.setPropertyValueSingle("{layer}{steps[number % 4][0]}.Enabled", {steps[number % 4][1]})')
            for number in range(count)]


@benchmark("toggle-p99-cached", "x without", AT_MOST, 1.5)
def toggle_cached():
    """p99 of 500 frames with 20 toggles of layers, over that of the same flight without; programs and tiles cached by a
    flight before, all in one process. The median of three of each in turns."""
    poses = flights.over_europe(500)
    recording = flights.Recording()
    recording.fly(poses, toggles(20, 25))
    without, toggled = [], []
    for _ in range(3):
        recording.hold(poses[0], 30)
        without.append(recording.fly(poses))
        recording.hold(poses[0], 30)
        toggled.append(recording.fly(poses, toggles(20, 25)))
    frames = play(recording)["per_frame"]["frame_ms"]

    def p99(passes):
        return statistics.median(percentile(frames[part], 99) for part in passes)
    return p99(toggled) / p99(without)


@functools.lru_cache(maxsize=None)
def cold_toggling():
    poses = flights.over_europe(500)
    recording = flights.Recording()
    without = recording.fly(poses)
    recording.hold(poses[0], 30)
    toggled = recording.fly(poses, toggles(20, 25))
    with empty_shader_cache() as environment:
        stats = play(recording, environment=environment)
    frames = stats["per_frame"]["frame_ms"]
    return percentile(frames[toggled], 99) / percentile(frames[without], 99), stats["programs"]["frames_waited"]


@benchmark("toggle-p99-cold", "x without", AT_MOST, 3)
def toggle_cold():
    """As toggle-p99-cached, but the shader caches are empty at the start and nothing was toggled before."""
    return cold_toggling()[0]


@benchmark("toggle-cold-frames-waited", "frames", AT_MOST, 0)
def toggle_cold_frames_waited():
    """Frames of that flight in which the render thread waited for the program cache."""
    return cold_toggling()[1]


@benchmark("selection-1000-chunks", "ms", AT_MOST, 0.5)
def selection():
    """Selection and culling of 1000 visited chunks on one thread: the slowest benchmark of bench-chunk-tree that visits
    at least so many (its counter `visited`), median processor time of 5 repetitions, by the chunk and times 1000."""
    text = run("bench-chunk-tree", "--benchmark_format=json", "--benchmark_repetitions=5",
               "--benchmark_report_aggregates_only=true")
    to_ms = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    times = [entry["cpu_time"] * to_ms[entry["time_unit"]] / entry["visited"] * 1000
             for entry in read_json(text, "bench-chunk-tree")["benchmarks"]
             if entry.get("aggregate_name") == "median" and entry.get("visited", 0) >= 1000]
    if not times:
        raise Failed("bench-chunk-tree: no benchmark visits 1000 chunks")
    return max(times)


@benchmark("peak-memory", "MiB", AT_MOST, MEMORY_LIMIT_MIB)
def peak_memory():
    """Greatest resident memory on the descent to the Alps and over Europe with layers toggled. Goal: the cache budgets
    of 512 + 512 + 64 MiB, and 300."""
    recording = flights.Recording()
    recording.fly(flights.descent_to_the_alps(300))
    recording.fly(flights.over_europe(500), toggles(20, 25))
    return play(recording)["memory"]["peak_rss"] / MIB


def seconds_to_first_settled_frame(environment=None):
    with tempfile.TemporaryDirectory(prefix="meridian-bench-") as folder:
        figures = Path(folder, "stats.json")
        start = time.perf_counter()
        run("meridian", *EARTH, "--headless", "--size", "1280x720", "--anchor", "Earth", "--camera", PLACES["orbit"],
            "--frames", 1, "--settle", 60, "--output", Path(folder, "frame.png"), "--stats", figures,
            "--log", "warning", "--set", "RenderEngine.ShowAttribution=false", environment=environment, timeout=120)
        seconds = time.perf_counter() - start
        if json.loads(figures.read_text())["settled"]["frames_timed_out"]:
            raise Failed("the frame did not settle within 60 s")
    return seconds


@benchmark("start-warm", "s", AT_MOST, 2)
def start_warm():
    """From the start of the process to its end, with the settled Earth written to a picture: median of 5, after one
    that fills the caches."""
    seconds_to_first_settled_frame()
    return statistics.median(seconds_to_first_settled_frame() for _ in range(5))


@benchmark("start-cold", "s", AT_MOST, 6)
def start_cold():
    """The same with an empty shader cache and the data files dropped from the kernel's memory: median of 3."""
    def once():
        with empty_shader_cache() as environment:
            drop_data_from_memory()
            return seconds_to_first_settled_frame(environment)
    return statistics.median(once() for _ in range(3))
