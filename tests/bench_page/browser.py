"""Pages in headless Chromium, and a server that records what they fetch."""
import http.server
import pathlib
import shutil
import subprocess
import tempfile
import threading

CHROMIUM = shutil.which("chromium")
OPTIONS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
           "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage",
           "--enable-logging=stderr"]


def run(page, *options):
    """What Chromium writes to standard output, and the lines of the page's console."""
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run([CHROMIUM, *OPTIONS, f"--user-data-dir={profile}", *options, pathlib.Path(page).as_uri()],
                              capture_output=True, timeout=600, check=False)
    errors = done.stderr.decode("utf-8", "replace")
    assert done.returncode == 0, errors
    return done.stdout.decode("utf-8"), [line for line in errors.splitlines() if ":CONSOLE" in line]


def dom(page):
    return run(page, "--dump-dom")


def screenshot(page, path, width, height, dark=False):
    scheme = ["--blink-settings=preferredColorScheme=0"] if dark else []
    return run(page, f"--window-size={width},{height}", f"--screenshot={path}", *scheme)[1]


def colours(png):
    """The colours of a picture's pixels, three bytes each."""
    rgb = subprocess.run(["ffmpeg", "-v", "error", "-i", png, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    return {rgb[i:i + 3] for i in range(0, len(rgb), 3)}


class Listener:
    """A server on this machine. `paths`: what was requested of it."""

    def __enter__(self):
        self.paths = paths = []

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                paths.append(self.path)
                self.send_error(404)

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def address(self, path):
        return f"http://127.0.0.1:{self.server.server_address[1]}/{path}"
