#!/usr/bin/env python3
"""Takes a picture of a recording at an exact time, in the real viewer, without a window.

    scripts/screenshot.py FILE.rrd OUT.png [--time last|SECONDS] [--size 1600x1000] [--timeline sim_time]

Standard library only. It starts `rerun --headless` on the file and drives it through `rerun viewer-mcp` (JSON-RPC on
standard streams). What it needs on the machine: the `rerun` program 0.36.3 on PATH (`pip install rerun-sdk==0.36.3`,
or RERUN=/path/to/rerun) and a Vulkan driver; without a graphics card Mesa's software one will do
(`apt-get install mesa-vulkan-drivers libvulkan1`). The same file, time and size give the same bytes on one machine.
"""

import argparse
import base64
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time

VERSION = "0.36.3"
NEEDS = (
    f"needed: the `rerun` program {VERSION} on PATH (pip install rerun-sdk=={VERSION}, or set RERUN to its path)\n"
    "        and a Vulkan driver (apt-get install mesa-vulkan-drivers libvulkan1 where there is no graphics card)"
)


class Failure(Exception):
    """Why there is no picture, for the user."""


class Control:
    """The viewer's control service, spoken to through `rerun viewer-mcp`."""

    def __init__(self, rerun, env):
        self.process = subprocess.Popen(
            [rerun, "viewer-mcp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            text=True, env=env,
        )
        self.count = 0
        client = {"name": "screenshot", "version": "1"}
        self.call("initialize", {"protocolVersion": "2025-03-26", "capabilities": {}, "clientInfo": client})
        self.send({"jsonrpc": "2.0", "method": "notifications/initialized"})

    def send(self, message):
        self.process.stdin.write(json.dumps(message) + "\n")
        self.process.stdin.flush()

    def call(self, method, params):
        self.count += 1
        self.send({"jsonrpc": "2.0", "id": self.count, "method": method, "params": params})
        for line in self.process.stdout:
            answer = json.loads(line)
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise Failure(f"the viewer refused {method}: {answer['error']}")
                return answer["result"]
        raise Failure("`rerun viewer-mcp` ended early")

    def tool(self, name, **arguments):
        return self.call("tools/call", {"name": name, "arguments": arguments})

    def close(self):
        self.process.stdin.close()
        self.process.terminate()
        self.process.wait()


def text(result):
    return "".join(part.get("text", "") for part in result.get("content", []))


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def check(rerun):
    """The program must be there and of the version that the recordings are of."""
    if not shutil.which(rerun):
        raise Failure(f"there is no `{rerun}` on PATH\n{NEEDS}")
    said = subprocess.run([rerun, "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout
    if VERSION not in said:
        raise Failure(f"`{rerun}` is not {VERSION}: {said.strip() or 'it says nothing'}\n{NEEDS}")


def timelines(control):
    """The viewer's timelines by name, with their ranges."""
    result = control.tool("viewer_state")
    if result.get("isError"):
        return {}
    recordings = json.loads(text(result)).get("recordings", [])
    return {line["timeline"]: line for recording in recordings for line in recording["timelines"]}


def loaded(control, viewer, name, deadline):
    """The timeline `name` once it has stopped growing."""
    last, still = None, 0
    while time.monotonic() < deadline:
        if viewer.poll() is not None:
            raise Failure(f"the viewer ended with code {viewer.returncode}\n{NEEDS}")
        line = timelines(control).get(name)
        now = json.dumps(line)
        still = still + 1 if line and line.get("max") is not None and now == last else 0
        if still >= 5:
            return line
        last = now
        time.sleep(0.2)
    raise Failure(f"the file did not load in time, or has no timeline `{name}`")


def picture(control, settle):
    """The picture once two in a row are equal: text and plots come some frames later than the scene."""
    last = None
    for _ in range(40):
        time.sleep(settle)
        result = control.tool("screenshot")
        images = [part["data"] for part in result.get("content", []) if part.get("type") == "image"]
        if not images:
            raise Failure(f"no picture: {text(result)}")
        if images[0] == last:
            break
        last = images[0]
    return base64.b64decode(last)


def shoot(options):
    rerun = os.environ.get("RERUN", "rerun")
    check(rerun)
    if not options.file.is_file():
        raise Failure(f"{options.file}: there is no such recording")
    port = free_port()
    with tempfile.TemporaryDirectory() as runtime:
        # RUST_LOG keeps notes out of the picture, CI keeps statistics from being sent.
        env = {**os.environ, "RUST_LOG": "error", "CI": "1", "XDG_RUNTIME_DIR": runtime}
        command = [rerun, "--headless", "--port", str(port), "--bind", "127.0.0.1", "--window-size", options.size]
        viewer = subprocess.Popen(
            [*command, str(options.file)], env=env, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        control = None
        try:
            deadline = time.monotonic() + options.timeout
            control = Control(rerun, env)
            # A viewer that hangs must not hang this.
            guard = threading.Timer(options.timeout + 60, viewer.kill)
            guard.daemon = True
            guard.start()
            while control.tool("connect", endpoint=f"http://127.0.0.1:{port}").get("isError"):
                if viewer.poll() is not None:
                    raise Failure(f"the viewer ended with code {viewer.returncode}\n{NEEDS}")
                if time.monotonic() > deadline:
                    raise Failure(f"the viewer did not answer in {options.timeout:.0f} s\n{NEEDS}")
                time.sleep(0.2)
            line = loaded(control, viewer, options.timeline, deadline)
            when = line["max"] if options.time == "last" else at(options.time, line)
            result = control.tool("set_time", timeline=options.timeline, time=when)
            if result.get("isError"):
                raise Failure(text(result))
            data = picture(control, 0.4)
            guard.cancel()
        finally:
            if control:
                control.close()
            viewer.terminate()
            viewer.wait()
    options.out.write_bytes(data)


def at(given, line):
    """Seconds as the timeline counts: nanoseconds on a duration, whole numbers on a sequence."""
    return int(given) if "sequence" in str(line.get("type", "")).lower() else round(float(given) * 1e9)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, metavar="FILE.rrd")
    parser.add_argument("out", type=pathlib.Path, metavar="OUT.png")
    parser.add_argument("--time", default="last", metavar="last|SECONDS")
    parser.add_argument("--size", default="1600x1000", metavar="WIDTHxHEIGHT")
    parser.add_argument("--timeline", default="sim_time")
    parser.add_argument("--timeout", type=float, default=120.0, metavar="SECONDS", help="for the file to load")
    options = parser.parse_args()
    try:
        if options.time != "last":
            float(options.time)
        shoot(options)
    except ValueError:
        parser.error(f"--time {options.time}: expected `last` or seconds")
    except (Failure, OSError) as failure:
        print(f"screenshot: {failure}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
