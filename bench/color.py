"""Colours of spectra, for renderers that know RGB alone."""

import numpy as np


def observer(nm):
    """The CIE 1931 standard observer (Wyman, Sloan and Shirley 2013, eq. 4)."""
    def lobe(center, below, above):
        return np.exp(-0.5 * ((nm - center) * np.where(nm < center, below, above)) ** 2)

    x = 0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382)
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    return np.stack([x, y, z])


RGB_FROM_XYZ = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])


def rgb_of(points):
    """The linear sRGB of a spectrum of pairs of nm and value: a constant one has luminance 1 times its value."""
    nm = np.arange(360.0, 831.0)
    xyz = observer(nm)
    values = np.interp(nm, *np.array(points).T)
    return (RGB_FROM_XYZ @ (xyz * values).sum(1) / xyz[1].sum()).clip(0)


def luminance_of(points):
    """The luminance of a spectrum, as `rgb_of`."""
    nm = np.arange(360.0, 831.0)
    y = observer(nm)[1]
    return (y * np.interp(nm, *np.array(points).T)).sum() / y.sum()


def reflectance_of(points):
    """The RGB reflectance of a spectrum: white stays white."""
    return (rgb_of(points) / rgb_of([(360, 1), (830, 1)])).clip(0, 1)
