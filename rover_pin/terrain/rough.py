"""Rough ground: a random height field whose power falls with the wavenumber by a stated law."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array


def rough_heights(seed: int, rms: float, hurst: float, nodes: int, spacing: float, shortest: float) -> Array:
    """Heights (nodes, nodes) [m] of a self-affine surface: isotropic, mean 0, root mean square `rms` [m].

    White noise from `numpy.random.PCG64(seed)` is filtered by |k|^-(hurst + 1), so that the power spectral
    density of the surface goes as |k|^-(2 hurst + 2) (Turcotte, Fractals and chaos in geology and geophysics,
    2nd ed., section 7), for waves from the map's side down to `shortest` [m] and nothing beyond. The field is
    periodic with period nodes * spacing. The same arguments give the same bits.
    """
    noise = np.random.Generator(np.random.PCG64(seed)).standard_normal((nodes, nodes))
    ky = np.fft.fftfreq(nodes, spacing)[:, None]
    kx = np.fft.rfftfreq(nodes, spacing)[None, :]
    k = np.hypot(kx, ky)
    k[0, 0] = np.inf
    law = np.where(k <= (1.0 + 1e-9) / shortest, k ** -(hurst + 1.0), 0.0)
    heights = np.fft.irfft2(np.fft.rfft2(noise) * law, s=(nodes, nodes))
    heights -= heights.mean()
    return np.asarray(heights * (rms / np.sqrt(np.mean(heights**2))), dtype=np.float64)
