#!/usr/bin/env python3
"""The npm package @mediapipe/holistic in headless Chromium on pictures that a test wrote.

run_holistic.py FOLDER PACKAGE: FOLDER has frames.json and the pictures as RGBA; the points go to FOLDER/results.json, a line
for each picture. Exit 0 where all pictures have been looked at.
"""
import functools
import http.server
import json
import pathlib
import subprocess
import sys
import threading

TIMEOUT_S = 240


class Handler(http.server.SimpleHTTPRequestHandler):
    package = page = results = done = None

    def translate_path(self, path):
        path = path.split("?")[0]
        if path.startswith("/holistic/"):
            return str(self.package / path.removeprefix("/holistic/"))
        return str(self.page) if path == "/page.html" else super().translate_path(path)

    def do_POST(self):
        said = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if "file" in said:
            self.results.write(json.dumps(said) + "\n")
        else:
            Handler.done.append(said)
        self.send_response(200)
        self.end_headers()
        if "file" not in said:
            finished.set()

    def log_message(self, *_):
        pass


folder, package = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
finished = threading.Event()
Handler.package, Handler.page, Handler.done = package, pathlib.Path(__file__).with_name("holistic.html"), []
Handler.results = open(folder / "results.json", "w", encoding="utf-8")
server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=str(folder)))
threading.Thread(target=server.serve_forever, daemon=True).start()
browser = subprocess.Popen(
    ["chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
     "--ignore-gpu-blocklist", "--remote-debugging-port=0", f"--user-data-dir={folder / 'profile'}",
     f"http://127.0.0.1:{server.server_port}/page.html"],
    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
finished.wait(TIMEOUT_S)
browser.terminate()
browser.wait(20)
Handler.results.close()
if Handler.done != [{"done": True}]:
    sys.exit(f"the original has not seen all pictures: {Handler.done or 'no answer'}")
