"""A page in headless Chromium, driven over the WebDriver protocol (W3C) of chromedriver. Python's standard library only."""

import base64
import contextlib
import json
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request

KEYS = {"ArrowLeft": "\ue012", "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015", "Enter": "\ue007",
        "Escape": "\ue00c", "Tab": "\ue004", "Home": "\ue011", "End": "\ue010", "Shift": "\ue008"}


def is_there():
    return bool(shutil.which("chromium") and shutil.which("chromedriver"))


class Browser:
    """One window. Everything that the console and the network say is kept for `problems`."""

    def __init__(self, width=1440, height=900):
        with contextlib.closing(socket.socket()) as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={self.port}", "--silent"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--enable-unsafe-swiftshader",
                     f"--window-size={width},{height}", "--force-color-profile=srgb"]
        capabilities = {"alwaysMatch": {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                                        "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}}
        self._wait_for_driver()
        self.session = ""
        self.session = "/session/" + self._call("POST", "/session", {"capabilities": capabilities})["sessionId"]
        self.problems = []

    def _wait_for_driver(self):
        for _ in range(200):
            with contextlib.suppress(OSError), urllib.request.urlopen(f"http://127.0.0.1:{self.port}/status") as answer:
                if json.load(answer)["value"]["ready"]:
                    return
            time.sleep(0.05)
        raise RuntimeError("chromedriver does not answer")

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data, method=method,
                                         headers={"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{path}: {error.read().decode()[:600]}") from None

    def close(self):
        with contextlib.suppress(Exception):
            self._call("DELETE", self.session)
        self.driver.terminate()
        self.driver.wait()

    def open(self, url):
        """Seconds until the page has loaded."""
        start = time.monotonic()
        self._call("POST", f"{self.session}/url", {"url": url})
        return time.monotonic() - start

    def before_pages(self, script):
        """From now on runs in each page before the page's own scripts do."""
        self._call("POST", f"{self.session}/goog/cdp/execute",
                   {"cmd": "Page.addScriptToEvaluateOnNewDocument", "params": {"source": script}})

    def run(self, script, *arguments):
        return self._call("POST", f"{self.session}/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script, *arguments, seconds=100):
        """Until the script returns something true, which is returned; a page that never does is a fault of its own."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if result := self.run(script, *arguments):
                return result
            time.sleep(0.02)
        raise AssertionError(f"never true: {script} {arguments}")

    def key(self, *names):
        """Presses keys together: the last one while the others are held."""
        keys = [KEYS.get(name, name) for name in names]
        down = [{"type": "keyDown", "value": key} for key in keys]
        up = [{"type": "keyUp", "value": key} for key in reversed(keys)]
        self._call("POST", f"{self.session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": down + up}]})

    def mouse(self, *moves):
        """("move", x, y), ("down",), ("up",): in the window's pixels."""
        actions = []
        for kind, *place in moves:
            if kind == "move":
                actions.append({"type": "pointerMove", "duration": 0, "x": round(place[0]), "y": round(place[1])})
            else:
                actions.append({"type": "pointerDown" if kind == "down" else "pointerUp", "button": 0})
        self._call("POST", f"{self.session}/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

    def click(self, selector):
        x, y = self.run("const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'nearest'});"
                        "const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2];", selector)
        self.mouse(("move", x, y), ("down",), ("up",))

    def command(self, name, **parameters):
        """Of the DevTools protocol."""
        return self._call("POST", f"{self.session}/goog/cdp/execute", {"cmd": name, "params": parameters})

    def size(self, width, height, is_phone=False):
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if is_phone else 1, mobile=is_phone)
        self.command("Emulation.setTouchEmulationEnabled", enabled=is_phone)

    def touch(self, *places):
        """One finger, down at the first place, along the others, up at the last; in the window's pixels."""
        for i, (x, y) in enumerate(places):
            self.command("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart", touchPoints=[{"x": x, "y": y}])
        self.command("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def press_quickly(self, name, times):
        """Presses a key so often, without waiting between."""
        key = KEYS.get(name, name)
        presses = [{"type": kind, "value": key} for _ in range(times) for kind in ("keyDown", "keyUp")]
        self._call("POST", f"{self.session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": presses}]})

    def type(self, selector, text):
        """Into a control; of one for files the name of a file."""
        element = self._call("POST", f"{self.session}/element", {"using": "css selector", "value": selector})
        self._call("POST", f"{self.session}/element/{next(iter(element.values()))}/value", {"text": text})

    def serious_faults(self, axe):
        """What axe-core, a script's text, finds that is serious or critical."""
        self.command("Runtime.evaluate", expression=axe)
        self.run("window.found = null; axe.run(document, {resultTypes: ['violations']}).then((result) => { window.found = result.violations"
                 ".filter(({impact}) => ['serious', 'critical'].includes(impact))"
                 ".map(({id, nodes}) => `${id}: ${nodes[0].target.join(' ')}`); });")
        return self.wait("return window.found && [window.found]")[0]

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self._call("GET", f"{self.session}/screenshot")))

    def complaints(self, allowed=()):
        """What the console has said (warnings and errors), and requests of anything but the addresses allowed."""
        said = [entry["message"] for entry in self._call("POST", f"{self.session}/se/log", {"type": "browser"})
                if entry["level"] in ("WARNING", "SEVERE")]
        for entry in self._call("POST", f"{self.session}/se/log", {"type": "performance"}):
            message = json.loads(entry["message"])["message"]
            if message["method"] != "Network.requestWillBeSent":
                continue
            url = message["params"]["request"]["url"]
            if not url.startswith(("data:", "blob:", "about:", "chrome:")) and not url.startswith(tuple(allowed)):
                said.append(f"a request of {url}")
        return said
