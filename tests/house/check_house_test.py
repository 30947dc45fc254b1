#!/usr/bin/env python3
"""check_house finds each kind of breach on a made-up tree, and nothing in one that is in order."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import check_house  # noqa: E402

ORDERLY = {
    "host/api/value.h": "#include <string>\n",
    "host/api/CMakeLists.txt": "meridian_room(meridian-api host/api SOURCES value.cpp LINKS fmt::fmt)",
    "host/graphics/program.h": '#include <epoxy/gl.h>\n#include "host/api/value.h"\n',
    "host/graphics/CMakeLists.txt": "meridian_room(meridian-graphics host/graphics OPENGL\n  LINKS meridian-api)",
    "modules/globebrowsing/geodesy/ellipsoid.h": '#include "host/api/value.h"\n',
    "modules/globebrowsing/geodesy/CMakeLists.txt":
        "meridian_room(globebrowsing-geodesy globebrowsing/geodesy LINKS meridian-api)",
    "modules/globebrowsing/tiling/tiling.h": '#include "globebrowsing/geodesy/ellipsoid.h"\n',
    "modules/globebrowsing/tiling/CMakeLists.txt":
        "meridian_room(globebrowsing-tiling globebrowsing/tiling PRIVATE_LINKS globebrowsing-geodesy)",
    "modules/globebrowsing/surface/surface.cpp":
        '#include "host/graphics/program.h"\n#include "globebrowsing/tiling/tiling.h"\n',
    "modules/globebrowsing/surface/CMakeLists.txt":
        "meridian_room(globebrowsing-surface globebrowsing/surface OPENGL\n"
        "  LINKS meridian-graphics globebrowsing-tiling)",
}

# Name, the files that differ from the orderly tree, and what a line of the report must say.
BREACHES = [
    ("an include of a higher room",
     {"modules/globebrowsing/geodesy/ellipsoid.h": '\n#include "globebrowsing/tiling/tiling.h"\n'},
     "geodesy/ellipsoid.h:2: includes globebrowsing/tiling/tiling.h: "
     "globebrowsing/tiling is not on a lower floor than globebrowsing/geodesy"),
    ("an include in angle brackets",
     {"modules/globebrowsing/geodesy/ellipsoid.h": "#include <globebrowsing/tiling/tiling.h>\n"},
     "globebrowsing/tiling is not on a lower floor"),
    ("an include that climbs",
     {"modules/globebrowsing/tiling/tiling.h": '#include "../surface/surface.h"\n'}, "name the room instead"),
    ("the host knowing the module",
     {"host/graphics/program.h": '#include "globebrowsing/tiling/tiling.h"\n'}, "the host must not know the module"),
    ("the module knowing the host's scene",
     {"modules/globebrowsing/surface/surface.cpp": '#include "host/scene/node.h"\n'}, "not host/scene"),
    ("OpenGL in a room free of it",
     {"modules/globebrowsing/tiling/tiling.h": "#include <epoxy/gl.h>\n"}, "free of OpenGL"),
    ("host/graphics in a room free of OpenGL",
     {"modules/globebrowsing/tiling/tiling.h": '#include "host/graphics/program.h"\n'},
     "globebrowsing/tiling is free of OpenGL, but host/graphics is not"),
    ("a link to a higher room",
     {"modules/globebrowsing/geodesy/CMakeLists.txt":
          "meridian_room(globebrowsing-geodesy globebrowsing/geodesy LINKS meridian-api globebrowsing-tiling)"},
     "globebrowsing-geodesy links globebrowsing-tiling"),
    ("a link made outside of meridian_room",
     {"modules/globebrowsing/geodesy/CMakeLists.txt":
          "meridian_room(globebrowsing-geodesy globebrowsing/geodesy LINKS meridian-api)\n"
          "target_link_libraries(globebrowsing-geodesy PRIVATE Meridian::globebrowsing-tiling)"},
     "links Meridian::globebrowsing-tiling"),
    ("a circle",
     {"modules/globebrowsing/geodesy/ellipsoid.h": '#include "globebrowsing/tiling/tiling.h"\n'},
     "a circle: globebrowsing/geodesy, globebrowsing/tiling"),
    ("a room without a floor",
     {"modules/globebrowsing/attic/box.h": '#include "globebrowsing/geodesy/ellipsoid.h"\n'},
     "globebrowsing/attic has no floor"),
    ("an include that nothing links",
     {"modules/globebrowsing/tiling/CMakeLists.txt": "meridian_room(globebrowsing-tiling globebrowsing/tiling)"},
     "globebrowsing/tiling includes globebrowsing/geodesy but does not link it"),
]


class CheckHouse(unittest.TestCase):
    def report(self, changed):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**ORDERLY, **changed}.items():
                file = Path(folder, name)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            return check_house.check(Path(folder))

    def test_an_orderly_tree_has_no_breach(self):
        self.assertEqual(self.report({}), [])

    def test_finds_each_kind_of_breach(self):
        for name, changed, expected in BREACHES:
            with self.subTest(name):
                self.assertTrue(any(expected in line for line in self.report(changed)), self.report(changed))

    def test_an_include_in_a_comment_is_none(self):
        self.assertEqual(self.report({"modules/globebrowsing/geodesy/ellipsoid.h":
                                      '/*\n#include "globebrowsing/tiling/tiling.h"\n*/\n'
                                      '// #include "globebrowsing/tiling/tiling.h"\n'}), [])


if __name__ == "__main__":
    unittest.main()
