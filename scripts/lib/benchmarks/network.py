"""The network: tiles from a server to decoded pixels, and views without servers. `scripts/bench --list` says what each is."""
import functools

from .programs import read_json, run
from .registry import AT_LEAST, AT_MOST, benchmark


@functools.lru_cache(maxsize=None)
def tiles():
    return read_json(run("bench-tiles"), "bench-tiles")


@functools.lru_cache(maxsize=None)
def outages():
    return read_json(run("bench-outage"), "bench-outage").values()


@benchmark("tiles-over-raw", "x raw", AT_LEAST, 0.8)
def over_raw():
    """256-pixel JPEG tiles a second from a local nginx to decoded pixels in the memory cache, 8 connections and 2
    decoding threads, over those that curl_multi and libjpeg-turbo alone bring; median of rounds in turn."""
    return tiles()["http"]["over_curl"]


@benchmark("tiles-over-raw-tls", "x raw", AT_LEAST, 0.8)
def over_raw_tls():
    """The same over TLS: the lesser of HTTP/1.1 with 8 connections and HTTP/2 with 32 requests."""
    return min(tiles()["tls"]["over_curl"], tiles()["http2"]["over_curl"])


@benchmark("tiles-over-gdal", "x GDAL", AT_LEAST, 2.5)
def over_gdal():
    """The same over HTTP, over what GDAL's TMS driver brings at its best: 4 threads, rows of 16 tiles, 8 connections."""
    return tiles()["http"]["over_gdal"]


@benchmark("tiles-over-gdal-tls", "x GDAL", AT_LEAST, 20)
def over_gdal_tls():
    """The same over TLS, HTTP/1.1: GDAL opens connections anew and reads all certificates for each."""
    return tiles()["tls"]["over_gdal"]


@benchmark("tiles-over-gdal-latency", "x GDAL", AT_LEAST, 10)
def over_gdal_latency():
    """Tiles a second with 16 connections to a server that answers after 30 ms, over GDAL's with its defaults, tile by
    tile."""
    return tiles()["latency"]["over_gdal"]


@benchmark("outage-frame-ratio", "x offline", AT_MOST, 1.2)
def outage_frame_ratio():
    """Median over frames, from 10 s on, of their time with all servers down, or stalled, over that of a globe beside it
    that is offline and shows the same from the cache; the greater of both outages."""
    return max(outage["frame_ratio"] for outage in outages())


@benchmark("outage-network-cpu", "% of a core", AT_MOST, 2)
def outage_network_cpu():
    """What the network layer's threads run meanwhile, by their own clocks."""
    return max(outage["network_cpu_percent"] for outage in outages())


@benchmark("outage-recovers", "s", AT_MOST, 1)
def outage_recovers():
    """Seconds until the view is complete once the servers answer again, beyond the longest pause of a server that is
    down, 15 s."""
    return max(outage["over_backoff_s"] for outage in outages())
