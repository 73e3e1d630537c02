"""Runs several renderers in turn, and what is made of their pictures and times."""

import statistics
import sys

import numpy as np

from peers import Missing

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Series:
    """The runs of one renderer on one scene."""

    def __init__(self, renderer, samples):
        self.renderer, self.name, self.samples = renderer, renderer.name, samples
        self.pictures, self.seconds, self.process_seconds = [], [], []

    def run(self, seed):
        render = self.renderer.render(seed)
        self.pictures.append(render.picture.astype(np.float64) @ LUMINANCE)
        self.seconds.append(render.seconds)
        self.process_seconds.append(render.process_seconds)

    @property
    def time(self):
        """Median seconds of a render."""
        return statistics.median(self.seconds)

    @property
    def process_time(self):
        """Median seconds of the whole program; none of a peer that stays."""
        return None if self.process_seconds[0] is None else statistics.median(self.process_seconds)

    @property
    def rate(self):
        """Samples per second."""
        return self.pictures[0].size * self.samples / self.time

    @property
    def mean(self):
        """Mean luminance of the picture."""
        return np.mean(self.pictures)

    @property
    def relvar(self):
        """Relative variance of one render: the mean over consecutive pairs of runs."""
        return np.mean([relative_variance(a, b) for a, b in zip(self.pictures, self.pictures[1:])])

    @property
    def cost(self):
        """What a render of unit relative variance costs, in seconds."""
        return self.time * self.relvar


def relative_variance(a, b):
    """Of luminance, from two pictures of different seeds: the variance of each pixel over its squared mean plus
    (2 % of the picture's mean)², clipped at its 99.9th percentile, in the mean over the picture."""
    mean, variance = (a + b) / 2, (a - b) ** 2 / 2
    relative = variance / (mean**2 + (0.02 * mean.mean()) ** 2)
    return relative.clip(max=np.percentile(relative, 99.9)).mean()


def tile_difference(a, b):
    """The 95th percentile over tiles of 8 × 8 pixels of the relative difference of their means."""
    def tiles(picture):
        height, width = (side // 8 * 8 for side in picture.shape)
        return picture[:height, :width].reshape(height // 8, 8, width // 8, 8).mean((1, 3))

    a, b = tiles(np.mean(a, 0)), tiles(np.mean(b, 0))
    return np.percentile(abs(a - b) / (b + 0.02 * b.mean()), 95)


def interleaved(openers, samples, runs, first_seed=1):
    """A series for each renderer that opens, its runs in turn with the others': what slows the machine down for a while
    slows all alike. One render before is not counted."""
    series = []
    try:
        for name, opener in openers:
            try:
                renderer = opener()
                series.append(Series(renderer, samples))
                renderer.render(first_seed + runs)
            except Missing as why:
                print(f"{name} is left out: {why}", file=sys.stderr)
                series = [s for s in series if s.name != name]
        for seed in range(first_seed, first_seed + runs):
            for one in series:
                one.run(seed)
    finally:
        for one in series:
            one.renderer.close()
    return series
