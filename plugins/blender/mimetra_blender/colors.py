"""Colours of fields, as Blender's colour attributes store them: linear, with alpha."""

import colorsys

import numpy as np

_OUTSIDE = (205 / 255, 190 / 255, 178 / 255)
# Dark blue through green to yellow, in sRGB. Even steps look even, also in grey.
_RAMP = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]]) / 255
_GOLDEN = 0.61803398875


def _linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _with_alpha(srgb):
    return np.column_stack([_linear(srgb), np.ones(len(srgb))]).astype(np.float32)


def _of_indices(values):
    """Colours of indices: neighbouring numbers differ, and negative ones are clay-coloured."""
    known, places = np.unique(values, return_inverse=True)
    table = np.array([colorsys.hsv_to_rgb(index * _GOLDEN % 1, 0.7, 0.95) if index >= 0
                      else _OUTSIDE for index in known.tolist()])
    return table[places]


def of_field(values):
    """Colours (N x 4) of N values: a ramp from the least to the largest, or a colour for each
    integer."""
    if values.dtype == np.int32:
        return _with_alpha(_of_indices(values))
    known = values[np.isfinite(values)]
    low, high = (known.min(), known.max()) if len(known) else (0, 1)
    shares = np.nan_to_num((values - low) / ((high - low) or 1), posinf=1, neginf=0)
    places = np.linspace(0, 1, len(_RAMP))
    return _with_alpha(np.column_stack([np.interp(shares, places, channel)
                                        for channel in _RAMP.T]))


def of_regions(region, colors, faces):
    """Colours (C x 4) of all corners. A face has the colour of the region of most of its corners;
    ties go to the lowest number. `region` (N) is -1 outside, and `colors` (R x 3, 0 to 255) are the
    colours in pictures."""
    sizes, corners = faces
    face = np.repeat(np.arange(len(sizes)), sizes)
    pairs, counts = np.unique(np.column_stack([face, region[corners]]), axis=0, return_counts=True)
    most = np.lexsort((pairs[:, 1], -counts, pairs[:, 0]))
    _, first = np.unique(pairs[most, 0], return_index=True)
    of_face = pairs[most[first], 1]
    table = np.vstack([np.asarray(colors) / 255, _OUTSIDE])
    return _with_alpha(np.repeat(table[of_face], sizes, axis=0))
