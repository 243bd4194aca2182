"""A page in headless Chromium, driven by the DevTools protocol over a WebSocket (RFC 6455), with Python's standard library alone."""
import base64
import json
import os
import socket
import struct
import subprocess
import tempfile
import time
import urllib.request


class Page:
    def __init__(self, path, width=1400, height=900, switches=()):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        environment = dict(os.environ, HOME=self.folder.name)
        # No GPU: the software renderer. The missing proxy makes any request fail; none is to be made.
        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--proxy-server=127.0.0.1:9",
             "--remote-debugging-port=0", "--remote-allow-origins=*", "--no-first-run", "--disable-background-networking",
             f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}", *switches, "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
        self.errors, self.requests, self.number, self.pending = [], [], 0, b""
        port = self._port()
        targets = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
        address = next(t["webSocketDebuggerUrl"] for t in targets if t["type"] == "page")
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=120)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /{address.split('/', 3)[3]} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.pending:
            self.pending += self.socket.recv(4096)
        self.pending = self.pending.split(b"\r\n\r\n", 1)[1]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(domain + ".enable")
        self.resize(width, height)
        self.url = "file://" + os.path.abspath(path)
        self.call("Page.navigate", url=self.url)

    def _port(self):
        for _ in range(600):
            try:
                with open(os.path.join(self.folder.name, "DevToolsActivePort")) as file:
                    return int(file.readline())
            except (OSError, ValueError):
                time.sleep(0.1)
        raise RuntimeError("chromium does not start")

    def _bytes(self, count):
        while len(self.pending) < count:
            more = self.socket.recv(1 << 16)
            if not more:
                raise RuntimeError("chromium has ended")
            self.pending += more
        taken, self.pending = self.pending[:count], self.pending[count:]
        return taken

    def _receive(self):
        text = b""
        while True:
            first, size = self._bytes(2)
            size &= 127
            if size == 126:
                size = struct.unpack(">H", self._bytes(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._bytes(8))[0]
            text += self._bytes(size)
            if first & 128:
                return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        text = json.dumps({"id": self.number, "method": method, "params": parameters}).encode()
        head = bytes([129]) + (bytes([128 | len(text)]) if len(text) < 126 else bytes([254]) + struct.pack(">H", len(text)) if len(text) < 65536
                               else bytes([255]) + struct.pack(">Q", len(text)))
        self.socket.sendall(head + bytes(4) + text)  # the mask is zero
        while True:
            message = self._receive()
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self._note(message)

    def _note(self, message):
        method, what = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(what["exceptionDetails"]["text"] + " " + what["exceptionDetails"].get("exception", {}).get("description", ""))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.errors.append(str(what["args"]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            # What the software renderer says of its own speed is no fault of the page.
            if "GPU stall due to ReadPixels" not in what["entry"]["text"]:
                self.errors.append(what["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            address = what["request"]["url"]
            if address != getattr(self, "url", "") and not address.startswith(("data:", "blob:")):
                self.requests.append(address)

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, expression, seconds=60):
        """Until an expression is true."""
        end = time.time() + seconds
        while time.time() < end:
            found = self.value(expression)
            if found:
                return found
            time.sleep(0.05)
        raise RuntimeError(f"never true: {expression}; errors: {self.errors}")

    def resize(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def mouse(self, kind, x, y, button="none", modifiers=0, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=0 if button == "none" else 1, modifiers=modifiers, clickCount=1, **more)

    def click(self, x, y):
        self.mouse("mousePressed", x, y, "left")
        self.mouse("mouseReleased", x, y, "left")
        self.settle()

    def drag(self, start, end, steps=8):
        self.mouse("mousePressed", *start, "left")
        for k in range(1, steps + 1):
            self.mouse("mouseMoved", *(a + (b - a) * k / steps for a, b in zip(start, end)), "left")
        self.mouse("mouseReleased", *end, "left")
        self.settle()

    def press(self, text):
        """Clicks the button with this text."""
        if not self.value(f"(b => b && (b.click(), true))([...document.querySelectorAll('button')].find(b => b.textContent.startsWith({json.dumps(text)})))"):
            raise RuntimeError(f"no button {text}")
        self.settle()

    def key(self, key, **more):
        """Types into the view, as a user does who has clicked it."""
        self.value("document.querySelector('.stage canvas').focus()")
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **more)
        self.settle()

    def settle(self):
        """Until what a command changed is laid out and drawn: a view that changes its size fits the part anew in the frame after."""
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()
