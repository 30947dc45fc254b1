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


def gdal(*command):
    return subprocess.run(list(map(str, command)), check=True, text=True, stdout=subprocess.PIPE).stdout


def describe(name):
    return json.loads(gdal("gdalinfo", "-json", FOLDER / name))


def values(name, longitude, latitude):
    """Of each band, at a place in degrees."""
    return [float(value) for value in gdal("gdallocationinfo", "-valonly", "-geoloc", FOLDER / name, longitude,
                                           latitude).split()]


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
        red, green, blue = values("earth_blue_marble.tif", 25, 23)
        self.assertTrue(red > green > blue, "the Sahara is sand-coloured")
        red, green, blue = values("earth_blue_marble.tif", -140, 0)
        self.assertTrue(blue > green > red, "the Pacific is blue")
        self.assertGreater(min(values("earth_blue_marble.tif", 0, -85)), 200, "Antarctica is white")
        self.assertGreater(min(values("earth_city_lights.tif", 2.35, 48.86)), 150, "Paris is lit")
        self.assertLess(values("moon_clementine.tif", -15, 35)[0], values("moon_clementine.tif", -11.4, -43.3)[0],
                        "Mare Imbrium is darker than Tycho")
        self.assertLess(values("mars_colour.tif", 69, 9)[0], values("mars_colour.tif", 25, 22)[0],
                        "Syrtis Major is darker than Arabia")

    def test_etopo5_has_its_values_on_nodes_of_a_twelfth_of_a_degree(self):
        transform = describe("earth_etopo5.tif")["geoTransform"]
        for found, expected in zip(transform, (-1 / 24, 1 / 12, 0, 90 + 1 / 24, 0, -1 / 12)):
            self.assertAlmostEqual(found, expected, places=12)
        for column, row in ((0, 0), (0, 1080), (1043, 744), (3432, 592), (4319, 1500), (2000, 2160)):
            source = gdal("gdallocationinfo", "-valonly", ETOPO5, column, row)
            self.assertEqual(values("earth_etopo5.tif", column / 12, 90 - row / 12), [float(source)])

    def test_relief_of_other_bodies_is_in_metres_where_it_belongs(self):
        for name, longitude, latitude, low, high in (
                ("mars_mola.tif", 226.2, 18.65, 20000, 21300),  # Olympus Mons
                ("mars_mola.tif", 62, -33, -8300, -6500),       # Badwater, the depth of Hellas
                ("moon_lola.tif", 201.4, 5.41, 10000, 10800),   # the highest place
                ("moon_lola.tif", 187.5, -70.4, -9200, -7500)):  # Antoniadi, the lowest
            with self.subTest((name, longitude, latitude)):
                if not (FOLDER / name).exists():
                    self.skipTest(f"no {name}: see data/README.md")
                self.assertTrue(low < values(name, longitude, latitude)[0] < high,
                                values(name, longitude, latitude))


if __name__ == "__main__":
    if not (FOLDER / "earth_etopo5.tif").exists():
        print(f"SKIPPED: no prepared data in {FOLDER}; run scripts/lib/prepare-data")
        sys.exit(77)
    unittest.main()
