"""A browser that tests drive: Chromium without a window, over a pair of pipes, by its DevTools protocol.

No other package stands between: a message is JSON that ends with a null byte, as puppeteer and playwright send them
(https://chromedevtools.github.io/devtools-protocol/). Also a script that takes pictures of a page, to be looked at:

    python tests/browser.py PAGE.html FOLDER
"""

from __future__ import annotations

import base64
import itertools
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
OPTIONS = ("--headless", "--no-sandbox", "--remote-debugging-pipe", "--disable-gpu", "--no-first-run",
           "--hide-scrollbars", "--force-color-profile=srgb", "--disable-background-networking")  # fmt: skip
WIDTHS = {"phone": 390, "tablet": 820, "desktop": 1360}
PATIENCE = 30.0  # s for an answer


def program() -> str | None:
    """The path of a browser; None where there is none."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Browser:
    """One page of a browser; ``said``: what it wrote on its console, and what it could not load."""

    def __init__(self) -> None:
        found = program()
        assert found, f"no browser: {', '.join(PROGRAMS)}; cure: apt-get install --no-install-recommends chromium"
        self._home = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        asked, self._write = os.pipe()
        self._read, told = os.pipe()
        pipes = f'exec "$0" "$@" 3<&{asked} 4>&{told}'
        command = ["bash", "-c", pipes, found, *OPTIONS, f"--user-data-dir={self._home.name}", "about:blank"]
        self._process = subprocess.Popen(command, pass_fds=(asked, told), stderr=subprocess.DEVNULL)
        os.close(asked)
        os.close(told)
        self._numbers, self._left, self.said = itertools.count(1), b"", list[str]()
        self._session: dict[str, str] = {}
        targets = self.ask("Target.getTargets")["targetInfos"]
        page = next(one["targetId"] for one in targets if one["type"] == "page")
        self._session = {"sessionId": self.ask("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]}
        for part in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{part}.enable")

    def __enter__(self) -> Browser:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._write)
        os.close(self._read)
        self._home.cleanup()

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """One command, and its answer."""
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": parameters, **self._session}
        os.write(self._write, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            answer = self._next()
            if answer.get("id") == number:
                assert "error" not in answer, (method, answer["error"])
                found: dict[str, Any] = answer["result"]
                return found
        raise TimeoutError(method)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._left:
            got = os.read(self._read, 1 << 20)
            assert got, "the browser has ended"
            self._left += got
        line, _, self._left = self._left.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        self._hear(message.get("method", ""), message.get("params", {}))
        return message

    def _hear(self, event: str, told: dict[str, Any]) -> None:
        if event == "Runtime.exceptionThrown":
            self.said.append(str(told["exceptionDetails"].get("exception", told["exceptionDetails"])))
        elif event == "Log.entryAdded" and told["entry"]["level"] in ("error", "warning"):
            self.said.append(told["entry"]["text"])
        elif event == "Runtime.consoleAPICalled" and told["type"] in ("error", "warning", "assert"):
            self.said.append(str(told["args"]))
        elif event == "Network.requestWillBeSent" and not told["request"]["url"].startswith(("file:", "data:")):
            self.said.append(f"asks the network for {told['request']['url']}")

    def open(self, page: Path) -> None:
        """Load a file, and wait until it is drawn."""
        self.ask("Page.navigate", url=page.absolute().as_uri())
        self.run("new Promise(done => { const ready = () => requestAnimationFrame(() => requestAnimationFrame(done));"
                 "document.readyState === 'complete' ? ready() : addEventListener('load', ready); })")  # fmt: skip

    def run(self, script: str) -> Any:
        """The value of an expression in the page, awaited."""
        found = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def resize(self, width: int, height: int = 900) -> None:
        """The window's size, pixels."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def prefer(self, scheme: str, medium: str = "screen") -> None:
        """Light or dark; on the screen or in print."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.ask("Emulation.setEmulatedMedia", media=medium, features=features)

    def press(self, key: str) -> None:
        """A key, down and up."""
        text = {"Enter": "\r"}.get(key, key if len(key) == 1 else "")
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=key, code=key, text=text if kind == "keyDown" else "",
                     windowsVirtualKeyCode={"Enter": 13, "Tab": 9}.get(key, 0))  # fmt: skip

    def picture(self, path: Path, top: float = 0.0, height: float = 900.0) -> None:
        """Part of the page as PNG."""
        width = self.run("innerWidth")
        clip = {"x": 0, "y": top, "width": width, "height": height, "scale": 1}
        data = self.ask("Page.captureScreenshot", format="png", clip=clip, captureBeyondViewport=True)["data"]
        path.write_bytes(base64.b64decode(data))


def main(page: Path, where: Path, step: float = 1700.0) -> None:
    """Pictures of the whole page at three widths, light and dark."""
    where.mkdir(parents=True, exist_ok=True)
    with Browser() as browser:
        for scheme in ("light", "dark"):
            browser.prefer(scheme)
            for name, width in WIDTHS.items():
                browser.resize(width)
                browser.open(page)
                height = float(browser.run("document.documentElement.scrollHeight"))
                for place in range(int(-(-height // step))):
                    part = min(step, height - place * step)
                    browser.picture(where / f"{name}-{scheme}-{place:02d}.png", place * step, part)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
