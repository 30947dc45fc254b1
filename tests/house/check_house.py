#!/usr/bin/env python3
"""Checks that the source tree keeps the house's rules: which room may know which.

usage: check_house.py ROOT

Reads the #include lines of all sources and the room targets that the CMakeLists.txt files link. Prints one line for
each breach and exits with 1 if there is any:
- a room includes or links a room that is not on a lower floor, or one that has no floor;
- rooms know each other in a circle;
- a room that must be free of OpenGL includes an OpenGL header or knows a room that is not free of it;
- the host includes the module, or the module includes more of the host than host/api and host/graphics;
- a room includes another whose target it does not link, directly or through others.
"""
import re
import sys
from collections import defaultdict
from pathlib import Path

# Ground up. Rooms on one floor do not know each other.
HOST_FLOORS = [["api"], ["graphics", "ephemeris", "scripting"], ["scene"], ["assets", "navigation"], ["recording"],
               ["ui"], ["app"]]
# "" is the module's own folder, where renderable, script library and module stand on each other.
MODULE_FLOORS = [["geodesy"], ["tiling"], ["network"], ["source"], ["streaming", "terrain"], ["providers"], ["layers"],
                 ["gpu", "chunks"], ["surface"], [""]]
FLOOR = {f"host/{room}": (0, level) for level, rooms in enumerate(HOST_FLOORS) for room in rooms}
FLOOR |= {f"globebrowsing/{room}".rstrip("/"): (1, level)
          for level, rooms in enumerate(MODULE_FLOORS) for room in rooms}
WITH_OPENGL = {"host/graphics", "host/ui", "host/app", "globebrowsing/gpu", "globebrowsing/surface", "globebrowsing"}
HOST_FOR_MODULE = {"host/api", "host/graphics"}
OPENGL_HEADER = re.compile(r"(epoxy|GL|GLES\d?|EGL|GLFW)/|glad/|imgui")

MODULE_FOLDER = "modules/globebrowsing"
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"\n]+)"|<([^>\n]+)>)', re.MULTILINE)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
COMMAND = re.compile(r"(\w+)\s*\(([^()]*)\)")
SOURCES = {".h", ".hpp", ".inl", ".cpp", ".cc"}


def room_of_folder(folder):
    """The room of a folder relative to the root, or None: "host/api", "globebrowsing/tiling", "globebrowsing"."""
    parts = folder.split("/")
    if parts[0] == "host" and len(parts) > 1:
        return "/".join(parts[:2])
    if folder == MODULE_FOLDER or folder.startswith(MODULE_FOLDER + "/"):
        return "/".join(parts[1:3])
    return None


def room_of_include(path):
    """The room that an include line names, or None when it names none of ours."""
    parts = path.split("/")
    if parts[0] == "host" and len(parts) > 2:
        return "/".join(parts[:2])
    if parts[0] == "globebrowsing" and len(parts) > 1:
        return "/".join(parts[:2]) if len(parts) > 2 else "globebrowsing"
    return None


def objection(room, other):
    """Why `room` may not know `other`; None if it may."""
    for name in (room, other):
        if name not in FLOOR:
            return f"{name} has no floor in the house"
    (wing, level), (other_wing, other_level) = FLOOR[room], FLOOR[other]
    if wing == 0 and other_wing == 1:
        return f"the host must not know the module, but {room} knows {other}"
    if wing == 1 and other_wing == 0:
        if other not in HOST_FOR_MODULE:
            return f"the module may know only {' and '.join(sorted(HOST_FOR_MODULE))} of the host, not {other}"
    elif other_level >= level:
        return f"{other} is not on a lower floor than {room}"
    if room not in WITH_OPENGL and other in WITH_OPENGL:
        return f"{room} is free of OpenGL, but {other} is not"
    return None


def check_includes(root):
    """Breaches in include lines; and which rooms each room includes, with one file that does."""
    breaches, edges = [], defaultdict(dict)
    for top in ("host", MODULE_FOLDER):
        for file in sorted((root / top).rglob("*")):
            if file.suffix not in SOURCES:
                continue
            name = file.relative_to(root).as_posix()
            room = room_of_folder(file.parent.relative_to(root).as_posix())
            if room is None:
                continue
            text = COMMENT.sub(lambda match: "\n" * match.group().count("\n"), file.read_text(errors="replace"))
            for match in INCLUDE.finditer(text):
                included = match.group(1) or match.group(2)
                place = f"{name}:{text.count(chr(10), 0, match.start()) + 1}"
                if room not in WITH_OPENGL and OPENGL_HEADER.match(included):
                    breaches.append(f"{place}: includes {included}, but {room} is free of OpenGL")
                if included.startswith("."):
                    breaches.append(f"{place}: includes {included}; name the room instead of climbing to it")
                other = room_of_include(included)
                if other is None or other == room:
                    continue
                edges[room].setdefault(other, place)
                why = objection(room, other)
                if why:
                    breaches.append(f"{place}: includes {included}: {why}")
    return breaches, edges


def read_targets(root):
    """Of every room declared in CMake: its target's place, and the targets that it links."""
    room_of_target, links, places = {}, defaultdict(set), {}
    for file in sorted(root.glob("host/**/CMakeLists.txt")) + sorted(root.glob(f"{MODULE_FOLDER}/**/CMakeLists.txt")):
        text = re.sub(r"#[^\n]*", "", file.read_text())
        for command, arguments in COMMAND.findall(text):
            words = arguments.split()
            if command == "meridian_room" and len(words) >= 2:
                target = words[0]
                room_of_target[target] = words[1]
                places[target] = file.relative_to(root).as_posix()
                keyword = None
                for word in words[2:]:
                    if word in ("SOURCES", "LINKS", "PRIVATE_LINKS", "OPENGL"):
                        keyword = word
                    elif keyword in ("LINKS", "PRIVATE_LINKS"):
                        links[target].add(word)
            elif command == "target_link_libraries" and words:
                links[words[0]].update(words[1:])
    return room_of_target, links, places


def check_links(root, included):
    """Breaches in CMake links, and in includes that nothing links."""
    room_of_target, links, places = read_targets(root)
    breaches, edges = [], defaultdict(dict)
    for target, room in room_of_target.items():
        for linked in sorted(links[target]):
            other = room_of_target.get(linked.removeprefix("Meridian::"))
            if other is None or other == room:
                continue
            edges[room].setdefault(other, places[target])
            why = objection(room, other)
            if why:
                breaches.append(f"{places[target]}: {target} links {linked}: {why}")
    for room in room_of_target.values():
        reached, waiting = set(), [room]
        while waiting:
            for other in edges[waiting.pop()]:
                if other not in reached:
                    reached.add(other)
                    waiting.append(other)
        for other, place in included[room].items():
            if other not in reached:
                breaches.append(f"{place}: {room} includes {other} but does not link it")
    return breaches, edges


def circles(edges):
    """One line for each set of rooms that know each other in a circle."""
    reachable = {}
    for room in edges:
        reached, waiting = set(), [room]
        while waiting:
            for other in edges.get(waiting.pop(), ()):
                if other not in reached:
                    reached.add(other)
                    waiting.append(other)
        reachable[room] = reached
    rings = {tuple(sorted(other for other in reached if room in reachable.get(other, ())))
             for room, reached in reachable.items() if room in reached}
    return [f"a circle: {', '.join(ring)}" for ring in sorted(rings)]


def check(root):
    """All breaches in the tree below `root`."""
    breaches, included = check_includes(root)
    link_breaches, linked = check_links(root, included)
    together = defaultdict(dict)
    for edges in (included, linked):
        for room, others in edges.items():
            together[room].update(others)
    return breaches + link_breaches + circles(together)


def main():
    if len(sys.argv) != 2:
        print("usage: check_house.py ROOT", file=sys.stderr)
        return 2
    root = Path(sys.argv[1])
    if not (root / "host/api").is_dir():
        print(f"{root}: no such tree; name the folder that holds host/", file=sys.stderr)
        return 2
    breaches = check(root)
    print("\n".join(breaches) if breaches else "the house is in order")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
