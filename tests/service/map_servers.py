"""MapServer and MapProxy on loopback, for the tests of map services.

Usage: map_servers.py PORT FOLDER. The folder holds world.map; /mapserv is MapServer with that file, /mapproxy is
MapProxy with mapproxy.yaml, where there is one. Every request's target is written to FOLDER/requests.
"""
import os
import subprocess
import sys
from socketserver import ThreadingMixIn
from wsgiref.simple_server import WSGIRequestHandler, WSGIServer, make_server

port, folder = int(sys.argv[1]), sys.argv[2]
mapproxy = None
if os.path.exists(os.path.join(folder, "mapproxy.yaml")):
    from mapproxy.wsgiapp import make_wsgi_app

    mapproxy = make_wsgi_app(os.path.join(folder, "mapproxy.yaml"))


def mapserv(environ, start_response):
    query = environ.get("QUERY_STRING", "")
    gateway = {
        "PATH": "/usr/bin:/bin",
        "MAPSERVER_CONFIG_FILE": os.path.join(folder, "mapserver.conf"),
        "MS_MAPFILE": os.path.join(folder, "world.map"),
        "REQUEST_METHOD": "GET",
        "QUERY_STRING": query,
        "SERVER_NAME": "127.0.0.1",
        "SERVER_PORT": str(port),
        "SCRIPT_NAME": "/mapserv",
    }
    answer = subprocess.run(["/usr/bin/mapserv"], env=gateway, capture_output=True, check=False).stdout
    head, _, body = answer.partition(b"\r\n\r\n")
    headers = [tuple(part.strip() for part in line.split(":", 1)) for line in head.decode().splitlines() if ":" in line]
    start_response("200 OK", headers + [("Content-Length", str(len(body)))])
    return [body]


def serve(environ, start_response):
    path, query = environ["PATH_INFO"], environ.get("QUERY_STRING", "")
    with open(os.path.join(folder, "requests"), "a", encoding="utf-8") as ledger:
        ledger.write(path + ("?" + query if query else "") + "\n")
    if path.startswith("/mapproxy") and mapproxy is not None:
        environ["SCRIPT_NAME"], environ["PATH_INFO"] = "/mapproxy", path[len("/mapproxy"):]
        return mapproxy(environ, start_response)
    if path == "/mapserv":
        return mapserv(environ, start_response)
    start_response("404 Not Found", [("Content-Length", "0")])
    return []


class Server(ThreadingMixIn, WSGIServer):
    daemon_threads = True


class Quiet(WSGIRequestHandler):
    def log_message(self, *_):
        pass


make_server("127.0.0.1", port, serve, Server, Quiet).serve_forever()
