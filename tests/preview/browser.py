"""Watches a spectral render in a browser: its page shows the picture within two seconds of the first pass and the spectrum under the mouse,
tells which pixels are not rendered, follows exposure and view, and says when the render has ended; nothing is fetched from elsewhere, and the
console stays silent.

browser.py PROGRAM SCENE
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

SENSOR = '/sensor={"resolution": [96, 96], "exposure_s": 0.02, "spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 20}}'


class Browser:
    """A browser without a window, which is told what to do through pipes: JSON that a zero byte ends."""

    def __init__(self, profile: str) -> None:
        to_read, self.to = os.pipe()
        self.back, to_write = os.pipe()
        command = ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", "--remote-debugging-pipe",
                   "--window-size=1100,760", "about:blank"]
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "bash", *command], pass_fds=(to_read, to_write),
                                        stderr=subprocess.DEVNULL)
        self.number = 0
        self.rest = b""
        self.events: list[dict] = []
        self.session: dict = {}
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = {"sessionId": self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]}

    def ask(self, method: str, **parameters) -> dict:
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters, **self.session}
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.hear()
            if answer.get("id") != self.number:
                self.events.append(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']}")
            else:
                return answer["result"]

    def hear(self) -> dict:
        while b"\0" not in self.rest:
            self.rest += os.read(self.back, 1 << 16)
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def value(self, expression: str):
        return self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)["result"].get("value")

    def wait_for(self, expression: str, seconds: float) -> float:
        begin = time.monotonic()
        while not self.value(expression):
            if time.monotonic() - begin > seconds:
                raise SystemExit(f"failed: no {expression} within {seconds} s")
            time.sleep(0.02)
        return time.monotonic() - begin

    def point_at(self, x: float, y: float) -> None:
        self.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()


def require(condition: bool, complaint: str) -> None:
    if not condition:
        raise SystemExit(f"failed: {complaint}")


def watch(browser: Browser, url: str) -> None:
    for domain in ("Runtime", "Log", "Network", "Page"):
        browser.ask(f"{domain}.enable")
    browser.ask("Page.navigate", url=url)
    browser.wait_for("typeof state !== 'undefined' && state && state.samples_per_pixel > 0", 20)
    took = browser.wait_for("document.getElementById('picture').naturalWidth === 96", 2)
    print(f"the picture came {took:.2f} s after the first pass")
    box = browser.value("(b => [b.left, b.top, b.width, b.height])(document.getElementById('picture').getBoundingClientRect())")
    browser.point_at(box[0] + box[2] * 40.5 / 96, box[1] + box[3] * 60.5 / 96)
    browser.wait_for("document.getElementById('position').textContent === 'Pixel 40, 60'", 2)
    require(browser.value("!document.getElementById('spectrum').hidden"), "no spectrum is drawn")
    drawn = "document.getElementById('spectrum').getContext('2d').getImageData(0, 0, 340, 200).data.some((v, i) => v === 255 && i % 4 === 0)"
    require(browser.value(drawn), "the spectrum has no line")
    browser.point_at(box[0] + box[2] * 2.5 / 96, box[1] + box[3] * 60.5 / 96)
    browser.wait_for("document.getElementById('position').textContent === 'Pixel 2, 60 is not rendered'", 2)
    require(browser.value("document.getElementById('spectrum').hidden"), "a spectrum is drawn of a pixel that is not rendered")
    before = browser.value("document.getElementById('picture').src")
    browser.value("document.getElementById('exposure').value = 2; document.getElementById('exposure').dispatchEvent(new Event('input'))")
    browser.wait_for("document.getElementById('picture').src.includes('exposure=2&')", 3)
    require(browser.value("document.getElementById('view').options.length") >= 2, "there are no views")
    require(browser.value("document.getElementById('picture').src") != before, "the exposure changes nothing")
    if shot := os.environ.get("ABBE_SCREENSHOT"):
        import base64
        with open(shot, "wb") as file:
            file.write(base64.b64decode(browser.ask("Page.captureScreenshot")["data"]))


def check_events(events: list[dict], url: str) -> None:
    for event in events:
        method, about = event.get("method"), event.get("params", {})
        require(method not in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled"), f"the console says {about}")
        if method == "Network.requestWillBeSent":
            fetched = about["request"]["url"]
            require(fetched.startswith((url, "data:", "about:")), f"{fetched} is fetched")


def main(program: str, scene: str) -> None:
    with tempfile.TemporaryDirectory() as scratch:
        render = subprocess.Popen([program, "render", scene, "--set", SENSOR, "--time", "15", "--threads", "1", "--crop", "8,0,96,96",
                                   "--preview", "0", "--quiet", "-o", f"{scratch}/film.exr"], stderr=subprocess.PIPE, text=True, cwd=scratch)
        url = re.search(r"http://\S+", render.stderr.readline()).group()
        browser = Browser(f"{scratch}/profile")
        try:
            watch(browser, url)
            render.terminate()
            browser.wait_for("document.getElementById('ended').textContent.includes('has ended')", 10)
            require(browser.value("document.getElementById('picture').naturalWidth") == 96, "the last picture is gone")
            check_events(browser.events, url)
        finally:
            browser.close()
            render.kill()
            render.wait()


if __name__ == "__main__":
    if not shutil.which("chromium"):
        print("skipped: needs chromium")
        sys.exit(77)
    main(*sys.argv[1:])
