#!/usr/bin/env python3
"""The rasters that scripts/lib/prepare-data makes lie where they belong: known places have the values they must have."""
import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

FOLDER = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "meridian/data"
ETOPO5 = 'NETCDF:"/usr/share/ferret-vis/data/etopo5.cdf":ROSE'


def gdal(*command, places=()):
    lines = "".join(f"{x!r} {y!r}\n" for x, y in places)
    return subprocess.run(list(map(str, command)), check=True, text=True, input=lines, stdout=subprocess.PIPE).stdout


def describe(name):
    return json.loads(gdal("gdalinfo", "-json", FOLDER / name))


def values(name, *places):
    """Of each place (longitude, latitude in degrees) a list with the value of each band."""
    found = [float(value) for value in gdal("gdallocationinfo", "-valonly", "-geoloc", FOLDER / name,
                                            places=places).split()]
    bands = len(found) // len(places)
    return [found[first:first + bands] for first in range(0, len(found), bands)]


class PreparedData(unittest.TestCase):
    def test_every_raster_is_tiled_and_has_overviews(self):
        for file in FOLDER.glob("*.tif"):
            with self.subTest(file.name):
                for band in describe(file.name)["bands"]:
                    self.assertEqual(band["block"], [256, 256])
                    self.assertEqual(len(band["overviews"]), 4)

    def test_pictures_cover_their_body_from_longitude_minus_180(self):
        for name in ("earth_blue_marble", "earth_city_lights", "earth_precipitation_july", "moon_clementine",
                     "mars_colour"):
            with self.subTest(name):
                corners = describe(name + ".tif")["cornerCoordinates"]
                self.assertEqual((corners["upperLeft"], corners["lowerRight"]), ([-180.0, 90.0], [180.0, -90.0]))

    def test_colours_are_those_of_the_place(self):
        sahara, pacific, antarctica = values("earth_blue_marble.tif", (25, 23), (-140, 0), (0, -85))
        self.assertTrue(sahara[0] > sahara[1] > sahara[2], "the Sahara is sand-coloured")
        self.assertTrue(pacific[2] > 2 * pacific[0], f"the Pacific is blue, not {pacific}")
        self.assertGreater(min(antarctica), 200, "Antarctica is white")
        self.assertGreater(min(values("earth_city_lights.tif", (2.35, 48.86))[0]), 150, "Paris is lit")
        imbrium, tycho = values("moon_clementine.tif", (-15, 35), (-11.4, -43.3))
        self.assertLess(imbrium, tycho, "Mare Imbrium is darker than Tycho")
        syrtis_major, arabia = values("mars_colour.tif", (69, 9), (25, 22))
        self.assertLess(syrtis_major, arabia, "Syrtis Major is darker than Arabia")

    def test_etopo5_has_its_values_on_nodes_of_a_twelfth_of_a_degree(self):
        transform = describe("earth_etopo5.tif")["geoTransform"]
        for found, expected in zip(transform, (-1 / 24, 1 / 12, 0, 90 + 1 / 24, 0, -1 / 12)):
            self.assertAlmostEqual(found, expected, places=12)
        nodes = ((0, 0), (0, 1080), (1043, 744), (3432, 592), (4319, 1500), (2000, 2160))
        source = [[float(value)] for value in gdal("gdallocationinfo", "-valonly", ETOPO5, places=nodes).split()]
        self.assertEqual(values("earth_etopo5.tif", *((column / 12, 90 - row / 12) for column, row in nodes)), source)

    def test_relief_of_other_bodies_is_in_metres_where_it_belongs(self):
        for name, longitude, latitude, low, high in (
                ("mars_mola.tif", 226.2, 18.65, 20000, 21300),  # Olympus Mons
                ("mars_mola.tif", 62, -33, -8300, -6500),       # Badwater, the depth of Hellas
                ("moon_lola.tif", 201.4, 5.41, 10000, 10800),   # the highest place
                ("moon_lola.tif", 187.5, -70.4, -9200, -7500)):  # Antoniadi, the lowest
            with self.subTest((name, longitude, latitude)):
                if not (FOLDER / name).exists():
                    self.skipTest(f"no {name}: see data/README.md")
                height = values(name, (longitude, latitude))[0][0]
                self.assertTrue(low < height < high, height)


if __name__ == "__main__":
    if not (FOLDER / "earth_etopo5.tif").exists():
        print(f"SKIPPED: no prepared data in {FOLDER}; run scripts/lib/prepare-data")
        sys.exit(77)
    unittest.main()
