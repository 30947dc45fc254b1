"""Trees of assets. `scripts/bench --list` says what each is."""
import os
import re
import tempfile
import time
from pathlib import Path

from .programs import Failed, run
from .registry import AT_MOST, benchmark

# OpenSpace's own tree at its commit 37e7e4f9: assets that declare globes, globes in them, assets that add layers to
# them, layers, and further assets that these require.
GLOBE_ASSETS, GLOBES, LAYER_ASSETS, LAYERS, REQUIRED = 70, 446, 486, 1209, 635


def shares(total, parts):
    """How many of the total each part has."""
    return [total * (part + 1) // parts - total * part // parts for part in range(parts)]


def globe_text(identifier, number):
    return f"""local {identifier} = {{
  Identifier = "{identifier}",
  Transform = {{ Translation = {{ Type = "StaticTranslation", Position = {{ {number} * 1e8, 0, 0 }} }} }},
  Renderable = {{ Type = "RenderableGlobe", Radii = {{ 6378137, 6378137, 6356752 }}, PerformShading = false }},
  GUI = {{ Name = "Body {number}", Path = "/Solar System" }}
}}
asset.onInitialize(function() openspace.addSceneGraphNode({identifier}) end)
asset.onDeinitialize(function() openspace.removeSceneGraphNode({identifier}) end)
asset.export("{identifier}", {identifier}.Identifier)
"""


def layer_text(identifier, globe):
    return f"""local {identifier} = {{
  Identifier = "{identifier}", Name = "{identifier}", FilePath = asset.resource("{identifier}.vrt"),
  Description = [[What it shows.]], ZIndex = 1
}}
asset.onInitialize(function() openspace.globebrowsing.addLayer({globe}, "ColorLayers", {identifier}) end)
asset.onDeinitialize(function() openspace.globebrowsing.deleteLayer({globe}, "ColorLayers", {identifier}) end)
"""


def write_tree(folder):
    """A tree of that shape: globes whose assets require what is shared, and layers, whose assets require a globe's."""
    for number in range(REQUIRED):
        before = f'asset.require("./shared{number // 2}")\n' if number else ""
        Path(folder, f"shared{number}.asset").write_text(f'{before}asset.export("Number", {number})\n')
    number = 0
    for place, count in enumerate(shares(GLOBES, GLOBE_ASSETS)):
        text = f'asset.require("./shared{place * REQUIRED // GLOBE_ASSETS}")\n'
        for number in range(number, number + count):
            text += globe_text(f"Body{number}", number)
        number += 1
        Path(folder, f"globe{place}.asset").write_text(text)
    number = 0
    for place, count in enumerate(shares(LAYERS, LAYER_ASSETS)):
        globe = place * 7 % GLOBE_ASSETS
        text = f'local globe = asset.require("./globe{globe}")\n'
        text += f'asset.require("./shared{REQUIRED - 1 - place}")\n'
        for number in range(number, number + count):
            text += layer_text(f"Layer{number}", f"globe.Body{sum(shares(GLOBES, GLOBE_ASSETS)[:globe])}")
            Path(folder, f"Layer{number}.vrt").write_text("<VRTDataset/>")
        number += 1
        Path(folder, f"layer{place}.asset").write_text(text)


@benchmark("validate-seconds", "s", AT_MOST, 40)
def validate():
    """`meridian --validate` of a tree with the numbers of assets, globes and layers that OpenSpace's own has, or of the
    folder that MERIDIAN_OPENSPACE_ASSETS names."""
    with tempfile.TemporaryDirectory(prefix="meridian-bench-") as made:
        named = os.environ.get("MERIDIAN_OPENSPACE_ASSETS")
        if not named:
            write_tree(made)
        start = time.perf_counter()
        text = run("meridian", "--validate", named or made, "--log", "error", accepted=(0, 3))
        seconds = time.perf_counter() - start
    counts = re.search(r"assets (\d+) ok (\d+) failed; globes (\d+); layers (\d+) usable (\d+)", text)
    if not counts:
        raise Failed(f"meridian --validate: no summary in: {text.strip()}")
    found = tuple(int(count) for count in counts.groups())
    expected = (GLOBE_ASSETS + LAYER_ASSETS + REQUIRED, 0, GLOBES, LAYERS, LAYERS)
    if not named and found != expected:
        raise Failed(f"meridian --validate: {counts[0]}; expected {expected}")
    if named and not found[2]:
        raise Failed(f"{named}: no globes in it: {counts[0]}")
    return seconds
