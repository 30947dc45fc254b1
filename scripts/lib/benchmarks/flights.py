"""Flights for benchmarks, as ASCII session recordings of version 03.00."""
import math

EARTH_RADII = (6378137.0, 6356752.314245)
# Noon in Greenwich at the June solstice: the northern flights below are in daylight. TDB seconds past J2000.
SIMULATION_TIME = 14860864.184
FRAMES_PER_SECOND = 30
# The program's defaults.
FIELD_OF_VIEW_DEGREES = 50
PICTURE_HEIGHT = 720


def nadir_pose(latitude_degrees, longitude_degrees, altitude):
    """Position (metres, in the Earth's frame) and rotation (w, x, y, z) of an eye that looks down, north up."""
    latitude, longitude = math.radians(latitude_degrees), math.radians(longitude_degrees)
    a, b = EARTH_RADII
    normal = (math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude), math.sin(latitude))
    curvature = a * a / math.sqrt((a * math.cos(latitude)) ** 2 + (b * math.sin(latitude)) ** 2)
    position = tuple((curvature * scale + altitude) * n for n, scale in zip(normal, (1, 1, (b / a) ** 2)))
    east = (-math.sin(longitude), math.cos(longitude), 0.0)
    north = tuple(normal[(i + 1) % 3] * east[(i + 2) % 3] - normal[(i + 2) % 3] * east[(i + 1) % 3] for i in range(3))
    # The camera looks along -z with +y up, so its axes are east, north and the normal.
    return position, quaternion(east, north, normal)


def quaternion(x, y, z):
    """(w, x, y, z) of the rotation whose matrix has these columns."""
    trace = x[0] + y[1] + z[2]
    if trace > 0:
        s = 2 * math.sqrt(1 + trace)
        return s / 4, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s
    if x[0] >= y[1] and x[0] >= z[2]:
        s = 2 * math.sqrt(1 + x[0] - y[1] - z[2])
        return (y[2] - z[1]) / s, s / 4, (y[0] + x[1]) / s, (z[0] + x[2]) / s
    if y[1] >= z[2]:
        s = 2 * math.sqrt(1 + y[1] - x[0] - z[2])
        return (z[0] - x[2]) / s, (y[0] + x[1]) / s, s / 4, (z[1] + y[2]) / s
    s = 2 * math.sqrt(1 + z[2] - x[0] - y[1])
    return (x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, s / 4


def places_to_1000_km(frames):
    """The flight that the peers were measured on: 20 000 km to 1000 km, exponentially, from 10 N 30 W to 40 N 30 E. For
    each frame latitude, longitude (degrees) and altitude (metres)."""
    steps = [frame / (frames - 1) for frame in range(frames)]
    return [(10 + 30 * t, -30 + 60 * t, 2e7 * (1e6 / 2e7) ** t) for t in steps]


def orbit_to_1000_km(frames):
    """Its poses."""
    return [nadir_pose(*place) for place in places_to_1000_km(frames)]


def outlines_to_1000_km(frames):
    """The same for a globe without perspective: latitude, longitude, and the radius in pixels of the Earth's outline."""
    scale = PICTURE_HEIGHT / 2 / math.tan(math.radians(FIELD_OF_VIEW_DEGREES) / 2)
    a = EARTH_RADII[0]
    return [(latitude, longitude, round(scale * a / math.sqrt(altitude * (2 * a + altitude))))
            for latitude, longitude, altitude in places_to_1000_km(frames)]


def descent_to_the_alps(frames):
    """20 000 km to 20 km above 46.5 N 8 E, exponentially, and then east along the range."""
    poses = []
    for frame in range(frames):
        t = frame / (frames - 1)
        down, along = min(t / 0.7, 1.0), max((t - 0.7) / 0.3, 0.0)
        poses.append(nadir_pose(26.5 + 20 * down, -12 + 20 * down + 4 * along, 2e7 * (2e4 / 2e7) ** down))
    return poses


def over_europe(frames):
    """Level at 3000 km, from 20 W to 40 E."""
    return [nadir_pose(45, -20 + 60 * frame / (frames - 1), 3e6) for frame in range(frames)]


class Recording:
    """Strings flights together; knows which frame of the run shows what when played at FRAMES_PER_SECOND."""

    def __init__(self):
        self.poses = []
        self.scripts = []

    def hold(self, pose, frames):
        """Stays there; returns nothing, for nobody looks at these frames."""
        self.poses += [pose] * frames

    def fly(self, poses, scripts=()):
        """Adds the poses, and scripts as (frame, text) from their start. The frames that this is, as a slice."""
        start = len(self.poses)
        self.poses += poses
        self.scripts += [(start + frame, text) for frame, text in scripts]
        return slice(start, len(self.poses))

    def write(self, path):
        entries = [(frame, 1, self._camera(frame, pose)) for frame, pose in enumerate(self.poses)]
        entries += [(frame, 0, f"script {self._time(frame)} {SIMULATION_TIME} 1 {text}")
                    for frame, text in self.scripts]
        lines = [line for _, _, line in sorted(entries)]
        path.write_text("OpenSpace_record/playback03.00A\n" + "\n".join(lines) + "\n")

    @staticmethod
    def _time(frame):
        return f"{frame / FRAMES_PER_SECOND:.9f}"

    def _camera(self, frame, pose):
        position, rotation = pose
        numbers = " ".join(repr(number) for number in (*position, *rotation))
        return f"camera {self._time(frame)} {SIMULATION_TIME} {numbers} 1 F Earth"
