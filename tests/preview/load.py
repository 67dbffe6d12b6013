"""What a render costs that twenty clients watch, while others come and go, beside one that nobody watches: no more than a fiftieth of the
processor time. Both tell their progress. Runs alternate, and the cheapest of each kind count, since other work disturbs them upwards.

load.py PROGRAM SCENE
"""
import json
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

CLIENTS = 20
RECONNECTS = 100
PAIRS = 3
LIMIT = 1.02


def ask(url: str) -> bytes:
    with urllib.request.urlopen(url, timeout=10) as answer:
        return answer.read()


def watch(url: str) -> None:
    """Does what the page does until the render ends."""
    seen = 0
    try:
        while True:
            state = json.loads(ask(url + "state"))
            if state["picture"] != seen:
                seen = state["picture"]
                ask(url + "picture.png?exposure=0")
                ask(url + "pixel?x=1&y=1")
            time.sleep(0.5)
    except OSError:
        return


def come_and_go(url: str) -> None:
    for _ in range(RECONNECTS):
        try:
            ask(url)
        except OSError:
            return
        time.sleep(0.05)


def address(log: str) -> str:
    while True:
        with open(log) as file:
            if found := re.search(r"http://\S+(?=\n)", file.read()):
                return found.group()
        time.sleep(0.01)


def cpu_seconds(program: str, scene: str, scratch: str, watched: bool) -> float:
    log = f"{scratch}/log.txt"
    with open(log, "w") as file:
        render = subprocess.Popen([program, "render", scene, "--spp", "50", "--threads", "2", "-o", f"{scratch}/film.exr", "--stats",
                                   f"{scratch}/stats.json", *(["--preview", "0"] if watched else [])], stderr=file, cwd=scratch)
    clients = []
    if watched:
        url = address(log)
        clients = [threading.Thread(target=watch, args=(url,)) for _ in range(CLIENTS)] + [threading.Thread(target=come_and_go, args=(url,))]
    for client in clients:
        client.start()
    if render.wait() != 0:
        with open(log) as file:
            raise SystemExit(f"failed: {file.read()}")
    for client in clients:
        client.join()
    with open(f"{scratch}/stats.json") as file:
        return json.load(file)["cpu_s"]


def main(program: str, scene: str) -> None:
    alone, watched = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for _ in range(PAIRS):
            alone.append(cpu_seconds(program, scene, scratch, False))
            watched.append(cpu_seconds(program, scene, scratch, True))
    ratio = min(watched) / min(alone)
    print(f"alone {sorted(alone)} s, watched {sorted(watched)} s: {100 * (ratio - 1):.2f} % more")
    if ratio > LIMIT:
        raise SystemExit(f"failed: watching costs {100 * (ratio - 1):.2f} %, allowed {100 * (LIMIT - 1):.0f} %")


if __name__ == "__main__":
    main(*sys.argv[1:])
