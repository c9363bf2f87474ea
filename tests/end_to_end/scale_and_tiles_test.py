"""`madori tiles` killed in the middle of a download, and `madori scale --apply` killed at any moment, leave a
consistent site. Usage: scale_and_tiles_test.py MADORI"""
import csv
import http.server
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

from PIL import Image, ImageDraw
import yaml

MADORI = sys.argv[1]


def png(size=256):
    picture = Image.effect_noise((size, size), 60).convert("RGB")
    out = io.BytesIO()
    picture.save(out, "PNG")
    return out.getvalue()


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, stall_at):
        self.stall_at, self.count, self.stalled, self.tile = stall_at, 0, threading.Event(), png()
        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        s = self.server
        s.count += 1
        self.send_response(200)
        self.send_header("Content-Type", "image/png")
        self.send_header("Content-Length", str(len(s.tile)))
        self.end_headers()
        if s.count == s.stall_at:
            self.wfile.write(s.tile[: len(s.tile) // 2])
            self.wfile.flush()
            s.stalled.set()
            time.sleep(20)
        else:
            self.wfile.write(s.tile)

    def log_message(self, *_):
        pass


def make_site(folder):
    drawing = folder / "plan.png"
    picture = Image.new("L", (1200, 900), 255)
    draw = ImageDraw.Draw(picture)
    draw.rectangle([100, 100, 1100, 800], outline=0, width=8)
    draw.line([600, 100, 600, 800], fill=0, width=8)
    picture.save(drawing)
    site = folder / "site"
    subprocess.run([MADORI, "import", drawing, "--site", site], check=True, stdout=subprocess.DEVNULL)
    (site / "routes").mkdir()
    (site / "routes/tree.csv").write_text("ID,EDA\n0,1\n1,0\n")
    (site / "routes/path.csv").write_text("ID,x,y\n0,200,200\n1,500,300\n")
    return site


def whole_tiles(site):
    found = [f for f in (site / "tiles/16").rglob("*.png")]
    for file in found:
        Image.open(file).load()
    return len(found)


def tiles_survive_a_kill(site):
    command = lambda server: [MADORI, "tiles", site, "--lat", "35.46", "--lon", "136.74", "--zoom", "16",
                              "--radius-m", "600", "--json", "-", "--source",
                              f"http://127.0.0.1:{server.server_address[1]}/{{z}}/{{x}}/{{y}}.png"]
    server = Server(stall_at=4)
    process = subprocess.Popen(command(server), stdout=subprocess.DEVNULL)
    assert server.stalled.wait(30), "the download never reached its fourth tile"
    process.kill()
    process.wait()
    assert whole_tiles(site) == 3, "the tiles that were complete are not all there, or a broken one is"
    source = json.loads((site / "tiles/source.json").read_text())
    port = source["url"].split(":")[2].split("/")[0]
    server.shutdown()
    server.server_close()
    again = http.server.ThreadingHTTPServer.__new__(Server)
    again.stall_at, again.count, again.stalled, again.tile = -1, 0, threading.Event(), png()
    http.server.ThreadingHTTPServer.__init__(again, ("127.0.0.1", int(port)), Handler)
    threading.Thread(target=again.serve_forever, daemon=True).start()
    report = json.loads(subprocess.run(command(again), check=True, capture_output=True).stdout)
    assert report["already_there"] == 3 and report["fetched"] == report["tiles"] - 3, report
    again.shutdown()
    again.server_close()
    offline = json.loads(subprocess.run(command(again), check=True, capture_output=True).stdout)
    assert offline["fetched"] == 0 and offline["already_there"] == offline["tiles"], offline


def lengths(site):
    """Metres a pixel as each metric file says it."""
    m_per_px = yaml.safe_load((site / "site.yaml").read_text())["scale"]["m_per_px"]
    walls = list(csv.DictReader(open(site / "walls.csv")))
    nodes = list(csv.DictReader(open(site / "routes/path.csv")))
    header = (site / "map.pgm").read_bytes()[:20].split()
    grid = yaml.safe_load((site / "map.yaml").read_text())["resolution"] * int(header[1]) / 1200
    right = max(max(float(w["x1"]), float(w["x2"])) for w in walls) / 1104
    return m_per_px, right, float(nodes[1]["x"]) / 500, grid


def scale(site, metres, **options):
    return subprocess.Popen([MADORI, "scale", site, "--known", f"100,100,1100,100={metres}", "--apply"],
                            stdout=subprocess.DEVNULL, **options)


def scale_survives_a_kill(site):
    start = time.monotonic()
    assert scale(site, 20).wait() == 0
    spent = time.monotonic() - start
    seen = set()
    for k in range(24):
        before, wanted = lengths(site)[0], 40 if k % 2 == 0 else 20
        process = scale(site, wanted, stderr=subprocess.DEVNULL)
        time.sleep(spent * 1.1 * (k + 1) / 24)
        process.kill()
        process.wait()
        # Whoever opens the site next finishes a change that was committed.
        subprocess.run([MADORI, "scale", site, "--known", "100,100,1100,100=20"], check=True, stdout=subprocess.DEVNULL)
        m_per_px, wall, node, grid = lengths(site)
        assert min(abs(m_per_px - before), abs(m_per_px - wanted / 1000)) < 1e-12, (k, m_per_px)
        assert abs(wall / m_per_px - 1) < 0.01 and abs(node / m_per_px - 1) < 1e-5, (k, m_per_px, wall, node)
        assert abs(grid / m_per_px - 1) < 0.01, (k, m_per_px, grid)
        seen.add(abs(m_per_px - before) < 1e-12)
    print("old and new states seen:", seen)


with tempfile.TemporaryDirectory() as folder:
    made = make_site(pathlib.Path(folder))
    tiles_survive_a_kill(made)
    scale_survives_a_kill(made)
print("ok")
