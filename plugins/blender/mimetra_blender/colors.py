"""Colours of fields, as Blender's colour attributes hold them: linear, with alpha."""

import colorsys

import numpy as np

_OUTSIDE = (0.55, 0.55, 0.55)
# Dark blue over green to yellow, in sRGB: even steps look even, in grey too.
_RAMP = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]]) / 255
_GOLDEN = 0.61803398875


def _linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _with_alpha(srgb):
    return np.column_stack([_linear(srgb), np.ones(len(srgb))]).astype(np.float32)


def _of_indices(values):
    """One colour for each index, grey for negative ones; neighbours differ."""
    known, places = np.unique(values, return_inverse=True)
    table = np.array([colorsys.hsv_to_rgb(index * _GOLDEN % 1, 0.7, 0.95) if index >= 0
                      else _OUTSIDE for index in known.tolist()])
    return table[places]


def of_field(values):
    """N x 4 for N values: a ramp from the least to the largest, or a colour for each integer."""
    if values.dtype == np.int32:
        return _with_alpha(_of_indices(values))
    known = values[np.isfinite(values)]
    low, high = (known.min(), known.max()) if len(known) else (0, 1)
    shares = np.nan_to_num((values - low) / ((high - low) or 1), posinf=1, neginf=0)
    places = np.linspace(0, 1, len(_RAMP))
    return _with_alpha(np.column_stack([np.interp(shares, places, channel)
                                        for channel in _RAMP.T]))
