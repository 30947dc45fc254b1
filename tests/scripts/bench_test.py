#!/usr/bin/env python3
"""scripts/bench derives its ratios rightly, from a made-up program whose frame times are known."""
import math
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts/lib"))

from benchmarks import flights, programs, spine  # noqa: E402

# 10 ms a frame, but `times` of those in the frames given.
PROGRAM = """\
#!/usr/bin/env python3
import json, sys
argument = lambda name: sys.argv[sys.argv.index(name) + 1]
frames = [10.0] * int(argument("--frames"))
for frame, times in {slow}.items():
    frames[frame] *= times
json.dump({{"frames": len(frames), "per_frame": {{"frame_ms": frames}},
           "programs": {{"frames_waited": 3}}, "memory": {{"peak_rss": 700 << 20}}}}, sys.stdout)
"""


def rotate(quaternion, vector):
    w, *u = quaternion
    cross = [u[(i + 1) % 3] * vector[(i + 2) % 3] - u[(i + 2) % 3] * vector[(i + 1) % 3] for i in range(3)]
    twice = [2 * c for c in cross]
    again = [u[(i + 1) % 3] * twice[(i + 2) % 3] - u[(i + 2) % 3] * twice[(i + 1) % 3] for i in range(3)]
    return [v + w * t + a for v, t, a in zip(vector, twice, again)]


class Flights(unittest.TestCase):
    def test_the_eye_is_above_its_place(self):
        # By PROJ 9: cct +proj=cart +ellps=WGS84
        position, _ = flights.nadir_pose(45, 90, 0)
        for found, expected in zip(position, (0.0, 4517590.8788, 4487348.4089)):
            self.assertAlmostEqual(found, expected, places=3)

    def test_the_eye_looks_down_with_north_up_everywhere(self):
        for latitude in (-89, -45, 0, 30, 89):
            for longitude in (-180, -100, 0, 45, 170):
                _, rotation = flights.nadir_pose(latitude, longitude, 1e6)
                a, b = math.radians(latitude), math.radians(longitude)
                down = (-math.cos(a) * math.cos(b), -math.cos(a) * math.sin(b), -math.sin(a))
                north = (-math.sin(a) * math.cos(b), -math.sin(a) * math.sin(b), math.cos(a))
                for axis, expected in (((0, 0, -1), down), ((0, 1, 0), north)):
                    for found, wanted in zip(rotate(rotation, axis), expected):
                        self.assertAlmostEqual(found, wanted, places=12, msg=(latitude, longitude))

    def test_a_recording_has_a_camera_line_a_frame_and_scripts_before_their_frame(self):
        recording = flights.Recording()
        recording.hold(flights.nadir_pose(0, 0, 1e6), 2)
        part = recording.fly(flights.over_europe(3), [(1, "a()")])
        self.assertEqual((part.start, part.stop), (2, 5))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "x.osrectxt")
            recording.write(file)
            lines = file.read_text().splitlines()
        self.assertEqual(lines[0], "OpenSpace_record/playback03.00A")
        self.assertEqual([line.split()[0] for line in lines[1:]],
                         ["camera", "camera", "camera", "script", "camera", "camera"])
        self.assertTrue(lines[4].startswith("script 0.100000000 ") and lines[4].endswith(" 1 a()"))
        self.assertEqual(len(lines[5].split()), 13)


class Ratios(unittest.TestCase):
    def measure(self, slow, function):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder, "bench-flight")
            program.write_text(textwrap.dedent(PROGRAM.format(slow=slow)))
            program.chmod(0o755)
            before, programs.BIN = programs.BIN, Path(folder)
            try:
                return function()
            finally:
                programs.BIN = before

    def test_streaming_compares_the_cold_flight_with_the_warm_ones(self):
        self.assertEqual(self.measure({}, spine.streaming_flight), 1.0)
        # Ten of the first flight's 300 frames are thrice as slow; the first starts after 30 frames of standing.
        self.assertAlmostEqual(self.measure({30 + 9 * n: 3 for n in range(10)}, spine.streaming_flight), 3.0)

    def test_toggling_compares_the_medians_of_three_flights_each(self):
        flight = 500 + 30
        plain, toggled = [flight, 3 * flight, 5 * flight], [2 * flight, 4 * flight, 6 * flight]

        def slowed(starts):
            return self.measure({start + 20 * n: 2 for start in starts for n in range(20)}, spine.toggle_cached)
        self.assertAlmostEqual(slowed(toggled), 2.0)
        self.assertAlmostEqual(slowed(toggled[1:]), 2.0)
        self.assertAlmostEqual(slowed(toggled[1:2]), 1.0)
        self.assertAlmostEqual(slowed(plain), 0.5)
        self.assertAlmostEqual(slowed([0]), 1.0)

    def test_memory_is_in_mebibytes(self):
        self.assertEqual(self.measure({}, spine.peak_memory), 700)

    def test_a_missing_program_is_named(self):
        with self.assertRaisesRegex(programs.Failed, "bench-chunk-tree: no such program"):
            self.measure({}, spine.selection)

    def test_a_program_that_fails_is_quoted(self):
        with self.assertRaisesRegex(programs.Failed, "IndexError"):
            self.measure({10**6: 1}, spine.peak_memory)


if __name__ == "__main__":
    unittest.main()
