"""A headless Chromium, driven by its DevTools protocol."""

import base64
import itertools
import json
import shutil
import subprocess
import time
from pathlib import Path

import websocket

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# No window, no network of its own, nothing kept. A test machine is often root in a container, where the sandbox of
# Chromium cannot start; it opens pages of ours only.
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--remote-debugging-port=0",
)
PATIENCE = 120.0
# Chromium itself may crash while it starts on a loaded machine (seen once: a segmentation fault before it listened). No
# page of ours is open then, so it is started again.
STARTS = 3


class Crashed(RuntimeError):
    """Chromium ended before it listened."""


def find() -> str | None:
    """The path of a Chromium on this machine."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """One page in a Chromium of its own."""

    def __init__(self, program: str, folder: Path, size: tuple[int, int] = (1400, 900)):
        self.errors: list[str] = []
        self.requests: list[str] = []
        self._ids = itertools.count(1)
        command = [program, *FLAGS, f"--user-data-dir={folder}", f"--window-size={size[0]},{size[1]}", "about:blank"]
        try:
            port, path = self._start(command, folder)
            place = f"ws://127.0.0.1:{port}{path}"
            self._socket = websocket.create_connection(place, timeout=PATIENCE, suppress_origin=True)
            self._session = None
            targets = self.call("Target.getTargets")["targetInfos"]
            page = next(target["targetId"] for target in targets if target["type"] == "page")
            self._session = self.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
            for domain in ("Page", "Runtime", "Log", "Network"):
                self.call(f"{domain}.enable")
            width, height = size
            self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        except BaseException:
            self.close()
            raise

    def _start(self, command: list[str], folder: Path) -> tuple[str, str]:
        for start in itertools.count(1):
            self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                return self._wait_for(folder / "DevToolsActivePort")
            except Crashed:
                if start == STARTS:
                    raise
                shutil.rmtree(folder, ignore_errors=True)

    def _wait_for(self, file: Path) -> tuple[str, str]:
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            lines = file.read_text().split() if file.exists() else []
            if len(lines) == 2:
                return lines[0], lines[1]
            if self._process.poll() is not None:
                raise Crashed(f"Chromium ended with status {self._process.returncode} before it listened")
            time.sleep(0.05)
        raise TimeoutError("Chromium does not listen")

    def call(self, method: str, **parameters) -> dict:
        """Calls a method of the protocol; events that come before the answer are looked through for errors."""
        number = next(self._ids)
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        self._socket.send(json.dumps(message))
        while True:
            answer = json.loads(self._socket.recv())
            self._note(answer)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def _note(self, event: dict) -> None:
        details = event.get("params", {})
        match event.get("method"):
            case "Runtime.exceptionThrown":
                thrown = details["exceptionDetails"]
                self.errors.append(thrown.get("exception", {}).get("description", thrown["text"]))
            case "Runtime.consoleAPICalled" if details["type"] in ("error", "warning", "assert"):
                self.errors.append(str([argument.get("value") for argument in details["args"]]))
            case "Log.entryAdded" if details["entry"]["level"] in ("error", "warning"):
                self.errors.append(details["entry"]["text"])
            case "Network.requestWillBeSent" if not details["request"]["url"].startswith(("file:", "data:", "blob:")):
                self.requests.append(details["request"]["url"])

    def open(self, address: str) -> None:
        """Opens a page and waits until its viewer stands."""
        self.requests.clear()
        self.call("Page.navigate", url=address)
        self.wait("window.enmm !== undefined || document.getElementById('status')?.className === 'bad'")

    def run(self, script: str):
        """The value of an expression in the page; a promise is awaited."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, condition: str) -> None:
        """Waits until an expression is true."""
        until = time.monotonic() + PATIENCE
        while not self.run(condition):
            if time.monotonic() > until:
                raise TimeoutError(f"{condition}; errors: {self.errors}")
            time.sleep(0.05)

    def painted(self) -> None:
        """Waits until what was asked for is drawn."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def click(self, x: float, y: float) -> None:
        """Clicks at a place of the page (CSS pixels)."""
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.painted()

    def press(self, key: str, code: str | None = None) -> None:
        """Presses a key and lets it go."""
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, code=code or key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, code=code or key)
        self.painted()

    def screenshot(self) -> bytes:
        """The page as PNG."""
        self.painted()
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def close(self) -> None:
        """Ends the browser."""
        if hasattr(self, "_socket"):
            self._socket.close()
        self._process.terminate()
        try:
            self._process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
