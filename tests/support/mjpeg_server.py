"""Plays JPEG files as a network camera does: Motion JPEG over HTTP.

    mjpeg_server.py PATTERN --rate 30 --port-file FILE

The picture of a moment follows from the system's clock, so two servers play one recording in step.
"""
import argparse
import glob
import http.server
import os
import random
import socket
import threading
import time


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("pictures", help="pattern of the JPEG files")
    parser.add_argument("--rate", type=float, default=30, help="pictures per second")
    parser.add_argument("--first", type=int, help="play the first N pictures only, over and over")
    parser.add_argument("--port", type=int, default=0, help="0: any that is free")
    parser.add_argument("--port-file", required=True, help="file that gets the port")
    parser.add_argument("--jitter", type=float, default=0, help="largest delay of a picture, s")
    parser.add_argument("--cut", type=int, default=0, help="send half of every N-th picture")
    parser.add_argument("--stop-after", type=int, default=0, help="stop after N pictures")
    parser.add_argument("--gone-file", default="", help="stop while this file exists")
    parser.add_argument("--stop", choices=["close", "hang"], default="close",
                        help="close the connection, or keep it and send nothing")
    return parser.parse_args()


class Camera:
    """What all connections share."""

    def __init__(self, given):
        self.given = given
        self.pictures = []
        for name in sorted(glob.glob(given.pictures))[:given.first]:
            with open(name, "rb") as file:
                self.pictures.append(file.read())
        if not self.pictures:
            raise SystemExit(f"{given.pictures}: no such files")
        self.lock = threading.Lock()
        self.sent = 0

    def gone(self):
        return (0 < self.given.stop_after <= self.sent or
                bool(self.given.gone_file) and os.path.exists(self.given.gone_file))

    def play(self, send):
        """Sends pictures until the camera stops."""
        delays = random.Random(1)
        last = int(time.time() * self.given.rate)
        while not self.gone():
            last = max(last + 1, int(time.time() * self.given.rate))
            wait = last / self.given.rate - time.time() + delays.uniform(0, self.given.jitter)
            time.sleep(max(0, wait))
            picture = self.pictures[last % len(self.pictures)]
            with self.lock:
                self.sent += 1
                if self.given.cut and self.sent % self.given.cut == 0:
                    picture = picture[:len(picture) // 2]
            send(picture)
        while self.given.stop == "hang" and self.gone():
            time.sleep(0.02)


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        camera = self.server.camera
        if camera.gone() and camera.given.stop == "close":
            self.send_error(503)
            return
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=picture")
        self.end_headers()
        try:
            camera.play(self.send)
        except OSError:
            pass  # the other side left

    def send(self, picture):
        head = f"--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {len(picture)}\r\n\r\n"
        self.wfile.write(head.encode() + picture + b"\r\n")

    def setup(self):
        super().setup()
        self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, True)

    def log_message(self, *_):
        pass


def main():
    given = arguments()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", given.port), Handler)
    server.camera = Camera(given)
    with open(given.port_file + ".part", "w", encoding="ascii") as file:
        file.write(str(server.server_port))
    os.rename(given.port_file + ".part", given.port_file)
    server.serve_forever()


main()
