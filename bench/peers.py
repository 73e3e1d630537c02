"""The renderers that are compared, each with one scene open: `render(seed)` gives a picture and its seconds."""

import json
import re
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
PEERS = ["scalar_rgb", "scalar_spectral", "llvm_ad_rgb", "llvm_ad_spectral", "cycles"]


@dataclass
class Render:
    picture: np.ndarray
    seconds: float  # of the rendering alone
    process_seconds: float | None = None  # of the whole program, where it runs anew for every render


class Missing(Exception):
    """A peer that cannot be run here, and why."""


class Tenfold:
    """The program of this project, run anew for every render."""

    name = "tenfold"

    def __init__(self, program, scene, threads, samples):
        self.command = [program, scene, "--nthreads", threads, "--spp", samples, "--progress", "json", "--log", "info"]
        self.load_seconds = None

    def render(self, seed):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "picture.pfm"
            start = time.perf_counter()
            ran = subprocess.run([str(a) for a in [*self.command, "--seed", seed, "-o", path]], capture_output=True, text=True)
            process_seconds = time.perf_counter() - start
            if ran.returncode:
                raise RuntimeError(ran.stderr)
            picture = read_pfm(path)
        completed = next(e for e in map(json.loads, ran.stdout.splitlines()) if e["event"] == "completed")
        log = re.sub(r"\x1b\[[0-9;]*m", "", ran.stderr)
        self.read_seconds, self.compile_seconds = (
            float(re.search(rf"{verb} .*?in ([\d.]+) s", log)[1]) for verb in ("read", "compiled")
        )
        self.load_seconds = self.read_seconds + self.compile_seconds
        return Render(picture, completed["seconds"], process_seconds)

    def close(self):
        pass


class AtOnce:
    """So many runs of the program at once, each with one thread. They share nothing but the machine: what they lose to each other, threads of one
    program lose, too."""

    name = "tenfold at once"

    def __init__(self, program, scene, copies, samples):
        self.copies = [Tenfold(program, scene, 1, samples) for _ in range(copies)]

    def render(self, seed):
        with ThreadPoolExecutor(len(self.copies)) as threads:
            renders = list(threads.map(lambda copy: copy.render(seed), self.copies))
        return Render(renders[0].picture, statistics.mean(render.seconds for render in renders))

    def close(self):
        pass


class Twin:
    """A peer in a process of its own, which keeps its scene. The first render, which may compile something, is none of those timed."""

    def __init__(self, name, scene, threads, samples):
        self.name = name
        script = "cycles_twin.py" if name == "cycles" else "mitsuba_twin.py"
        self.log = tempfile.TemporaryFile()
        command = [sys.executable, HERE / script, name, scene, threads, samples]
        self.process = subprocess.Popen(
            [str(a) for a in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log, text=True
        )
        self.load_seconds = self.answer()["load_seconds"]

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.log.seek(0)
            lines = self.log.read().decode(errors="replace").strip().splitlines()
            raise Missing(lines[-1] if lines else "it ended")
        return json.loads(line)

    def render(self, seed):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/picture.npy"
            self.process.stdin.write(json.dumps([seed, path]) + "\n")
            self.process.stdin.flush()
            seconds = self.answer()["seconds"]
            return Render(np.load(path), seconds)

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.log.close()


def read_pfm(path):
    """A picture of three channels, its first row on top."""
    with open(path, "rb") as file:
        assert file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        return np.fromfile(file, order + "f4", width * height * 3).reshape(height, width, 3)[::-1]
