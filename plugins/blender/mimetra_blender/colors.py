"""Colours of fields, as Blender's colour attributes hold them: linear, with alpha."""

import colorsys

import numpy as np

_OUTSIDE = (205 / 255, 190 / 255, 178 / 255)
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


def of_regions(region, colors, faces):
    """C x 4 for all corners: each face has the colour of the region (N, -1 outside) of most of its
    corners, of those the lowest number; `colors` (R x 3, 0 to 255) are those of pictures."""
    sizes, corners = faces
    face = np.repeat(np.arange(len(sizes)), sizes)
    pairs, counts = np.unique(np.column_stack([face, region[corners]]), axis=0, return_counts=True)
    most = np.lexsort((pairs[:, 1], -counts, pairs[:, 0]))
    _, first = np.unique(pairs[most, 0], return_index=True)
    of_face = pairs[most[first], 1]
    table = np.vstack([np.asarray(colors) / 255, _OUTSIDE])
    return _with_alpha(np.repeat(table[of_face], sizes, axis=0))
