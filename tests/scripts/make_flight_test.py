"""What scripts/make_flight writes, and what it says of way-points that cannot be used."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAD = ["globe Earth 6378137 6356752", "start 2026-06-21T06:00:00", "rate 2"]
POINTS = ["point 0 10 20 1000 0 -20", "point 4 11 21 900 0 -20"]


class MakeFlight(unittest.TestCase):
    def make(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            waypoints, output = Path(folder, "a.waypoints"), Path(folder, "a.osrectxt")
            waypoints.write_text("\n".join(lines))
            done = subprocess.run([sys.executable, "-B", ROOT / "scripts/make_flight", waypoints, output],
                                  capture_output=True, text=True, check=False)
            return done, output.read_text() if output.exists() else None

    def test_the_shipped_flight_is_made_of_its_way_points(self):
        flights = ROOT / "data/flights"
        _, text = self.make((flights / "earth_descent.waypoints").read_text())
        self.assertEqual(text, (flights / "earth_descent.osrectxt").read_text())

    def test_a_start_with_a_time_zone_is_the_same_moment(self):
        _, utc = self.make(*HEAD, *POINTS)
        _, zoned = self.make(HEAD[0], "start 2026-06-21T08:00:00+02:00", HEAD[2], *POINTS)
        self.assertEqual(utc, zoned)

    def test_what_cannot_be_used_is_named_with_its_line_and_nothing_is_written(self):
        for bad in ("script -5 a()", "point 5 10 20 1e300 0 0", "point 5 91 20 100 0 0", "point 3 1 2 3 4 5",
                    "start yesterday", "rate 0", "fly away", "script 9 late()"):
            done, text = self.make(*HEAD, *POINTS, bad)
            self.assertEqual(done.returncode, 1, bad)
            self.assertIn("a.waypoints", done.stderr, bad)
            self.assertNotIn("Traceback", done.stderr, bad)
            self.assertIsNone(text, bad)


if __name__ == "__main__":
    unittest.main()
