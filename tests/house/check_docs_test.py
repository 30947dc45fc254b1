#!/usr/bin/env python3
"""check_docs finds each kind of breach on a made-up tree, and nothing in one whose documents are true."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import check_docs  # noqa: E402

TRUE = {
    "README.md": "Read [the architecture](docs/architecture.md).\n",
    "docs/architecture.md": "# A\n\n## The house\n\n`tiling/tiling.h: Tiling, children` and `Tiling::parent` are in\n"
                            "`modules/globebrowsing/tiling/`; `host/api/value.{h,cpp}`; see `docs/*.md`.\n"
                            "`XDG_CACHE_HOME` is no path, nor is `build/release`, nor\n`a/b`.\n\n"
                            "```\n`host/no/such.h`\n```\n",
    "docs/command-line.md": "`--size WxH` and `frame_ms`\n",
    "docs/benchmarks.md": "`floor`\n",
    "modules/globebrowsing/tiling/tiling.h": "/// docs/architecture.md, The house: it is.\n"
                                             "class Tiling { void children(); void parent(); };\n",
    "host/api/value.h": "",
    "host/api/value.cpp": "",
    "host/app/options.cpp": 'app.add_option("--size", words.size)',
    "host/app/statistics_report.cpp": '{"frame_ms", 1}',
    "scripts/lib/benchmarks/spine.py": '@benchmark("floor", "x", AT_MOST, 1)',
}

# Name, the file that differs from the true tree, its text, and what a line of the report must say.
BREACHES = [
    ("a file that is not there", "README.md", "`tiling/cube.h`", "README.md:1: tiling/cube.h does not exist"),
    ("a folder that is not there", "README.md", "\n`host/attic/`", "README.md:2: host/attic/ does not exist"),
    ("a link to nowhere", "README.md", "[it](docs/no.md)", "docs/no.md does not exist"),
    ("one of two extensions", "README.md", "`tiling/tiling.{h,cpp}`", "tiling/tiling.{h,cpp} does not exist"),
    ("a pattern that nothing fits", "README.md", "`docs/*.txt`", "docs/*.txt does not exist"),
    ("a function that the file does not hold", "README.md", "`tiling/tiling.h: child`",
     "tiling/tiling.h holds no child"),
    ("a name that goes on in the next line", "README.md", "`tiling/tiling.h:\nTiling, gone`", "holds no gone"),
    ("a member that nobody has", "README.md", "`Tiling::gone`", "no source holds Tiling::gone"),
    ("a section that the document does not have", "host/api/value.h", "/// docs/architecture.md, The attic.",
     "host/api/value.h:1: docs/architecture.md has no section The attic"),
    ("a document that is not there", "host/api/value.h", "// docs/no.md, The attic.", "docs/no.md has no section"),
    ("an option that is not told", "docs/command-line.md", "`frame_ms` size", "does not tell of --size"),
    ("a figure that is not told", "docs/command-line.md", "`--size`", "does not tell of frame_ms"),
    ("a benchmark that is not told", "docs/benchmarks.md", "`floor-2`", "does not tell of floor"),
]


class CheckDocs(unittest.TestCase):
    def report(self, changed):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            for name, text in {**TRUE, **changed}.items():
                file = root / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            return check_docs.check(root)

    def test_a_true_tree_has_no_breach(self):
        self.assertEqual(self.report({}), [])

    def test_finds_each_kind_of_breach(self):
        for name, file, text, expected in BREACHES:
            with self.subTest(name):
                report = self.report({file: text})
                self.assertTrue(any(expected in line for line in report), report)


if __name__ == "__main__":
    unittest.main()
