"""The protocol between bench.py and a peer that renders in a process of its own: lines of JSON, pictures as .npy files."""

import json
import os
import sys
import time

import numpy as np


def serve(load, render):
    """`load()` makes the scene ready; `render(seed)` returns a picture. Both are timed, apart from the first render."""
    # What the peer prints goes to standard error: only the protocol's lines go out.
    out = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    start = time.perf_counter()
    load()
    print(json.dumps({"load_seconds": time.perf_counter() - start}), file=out)
    for line in sys.stdin:
        seed, path = json.loads(line)
        start = time.perf_counter()
        picture = render(seed)
        seconds = time.perf_counter() - start
        np.save(path, np.asarray(picture, np.float32))
        print(json.dumps({"seconds": seconds}), file=out)
