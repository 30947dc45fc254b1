"""MapProxy on loopback, below /mapproxy of the server that hands its requests on.

Usage: map_proxy.py PORT CONFIGURATION
"""
import sys
from socketserver import ThreadingMixIn
from wsgiref.simple_server import WSGIRequestHandler, WSGIServer, make_server

from mapproxy.wsgiapp import make_wsgi_app

port, configuration = int(sys.argv[1]), sys.argv[2]
mapproxy = make_wsgi_app(configuration)


def serve(environ, start_response):
    environ["SCRIPT_NAME"], environ["PATH_INFO"] = "/mapproxy", environ["PATH_INFO"][len("/mapproxy"):]
    return mapproxy(environ, start_response)


class Server(ThreadingMixIn, WSGIServer):
    daemon_threads = True


class Quiet(WSGIRequestHandler):
    def log_message(self, *_):
        pass


make_server("127.0.0.1", port, serve, Server, Quiet).serve_forever()
